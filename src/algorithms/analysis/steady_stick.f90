!> The permanent stick zone of steady cycles in closed form.
module mfv_steady_stick
   use, intrinsic :: ieee_arithmetic, only: ieee_quiet_nan, ieee_value
   use mfv_compliance, only: block_up
   use mfv_contact_path, only: contact_path_type, new_contact_path, segment_type
   use mfv_contact_system, only: load_type
   use mfv_cycle, only: cycle_type
   use mfv_edge_fields, only: most_patches
   use mfv_error, only: error_type
   use mfv_frictionless, only: apply_directly
   use mfv_kinds, only: wp
   use mfv_motions, only: control_force, motion_approach, motion_count, motion_shift, motions
   use mfv_simulation, only: simulation_type
   use mfv_tolerances, only: certified, significant
   use mfv_zone_edges, only: find_zone_edges, zone_edges_type
   implicit none
   private
   public :: steady_stick_length

contains

   !> Length of the permanent stick zone of steady cycles on a straight load path, by superposition: the contact under the normal
   !> force (P1 + P2)/2 - |Q2 - Q1|/(2 mu), where |Q2 - Q1| > mu |P2 - P1| (Barber, Davies and Hills 2011; half-planes without
   !> coupling, of any profiles). NaN for other bodies and load histories, where nothing would stick, and above most_patches.
   function steady_stick_length(simulation, cycle) result(length)
      type(simulation_type), intent(in) :: simulation
      type(cycle_type), intent(in) :: cycle
      real(wp) :: length
      type(contact_path_type) :: path
      type(segment_type) :: segment
      type(error_type), allocatable :: error
      type(zone_edges_type) :: edges
      real(wp) :: normal, change(2), friction

      length = ieee_value(1.0_wp, ieee_quiet_nan)
      if (cycle%return%edges%patches > most_patches .or. .not. superposes(simulation, cycle)) return
      associate (there => cycle%reversal%force, back => cycle%return%force)
         friction = simulation%contact%model%scene%friction%static%largest()
         change = abs([back(motion_approach) - there(motion_approach), back(motion_shift) - there(motion_shift)])
         if (.not. change(2) > friction*change(1)) return
         normal = 0.5_wp*(there(motion_approach) + back(motion_approach)) - 0.5_wp*change(2)/friction
      end associate
      if (.not. normal > 0.0_wp) return
      call new_contact_path(simulation%contact%model, .false., path)
      segment%friction = .false.
      segment%load(motion_approach) = load_type(control_force, 0.0_wp, normal)
      call apply_directly(path, segment, error=error)
      if (allocated(error)) return
      call find_zone_edges(path%model, path%state, edges)
      length = edges%contact_length
   end function steady_stick_length

   !> Whether tangential problems are superpositions of normal ones over a cycle: half-planes without coupling or wear under normal
   !> and tangential forces on a straight line, one coefficient of friction.
   logical function superposes(simulation, cycle)
      type(simulation_type), intent(in) :: simulation
      type(cycle_type), intent(in) :: cycle
      real(wp) :: normal(3)
      integer :: i

      superposes = .false.
      associate (model => simulation%contact%model, scene => simulation%contact%model%scene)
         if (.not. (model%tangential .and. model%upright) .or. cycle%turns /= 2) return
         if (scene%lower%deforms_as_circle() .or. scene%upper%deforms_as_circle() .or. scene%lower%is_matrix()) return
         if (scene%is_layered() .or. scene%wear%acts() .or. .not. scene%friction%is_coulomb()) return
         if (model%couples(block_up)) return
         if (maxval(model%static_friction) - minval(model%kinetic_friction, mask=model%can_touch) > certified) return
         do i = 1, motion_count
            if (motions(i)%optional .and. model%moves(i)) return
         end do
         normal = [cycle%start%force(motion_approach), cycle%lowest_force(motion_approach), cycle%highest_force(motion_approach)]
         superposes = maxval(normal) - minval(normal) <= significant*maxval(normal) .or. &
                      all(simulation%load([motion_approach, motion_shift])%control == control_force)
      end associate
   end function superposes

end module mfv_steady_stick
