!> A case: a scene with the requested output, and its text.
module mfv_case
   use mfv_body, only: body_type
   use mfv_case_data, only: case_data_type
   use mfv_kinds, only: wp
   use mfv_material, only: material_type
   use mfv_motions, only: motion_count, control_keep, controlled_key
   use mfv_near_field, only: near_field_of, near_field_type
   use mfv_profile_file, only: metres_in
   use mfv_scene, only: scene_type
   use mfv_simulation, only: history_events, simulation_type, states_auto
   use mfv_strings, only: add_text, string_type, to_text
   implicit none
   private
   public :: case_type

   type :: case_type
      type(scene_type) :: scene
      !> The input, verbatim, and the name of its file for messages.
      character(:), allocatable :: text, source
      !> Options of the program that change the result, such as --accuracy 1e-2 --estimate.
      character(len=64) :: options = ''
      !> Data in memory instead of files that the text names.
      type(case_data_type) :: data
      !> Path of the result file; empty: none.
      character(:), allocatable :: result_path
      !> See mfv_simulation.
      integer :: keep_history = history_events
      integer :: keep_states = states_auto
      !> See simulation_type.
      real(wp), allocatable :: stress_at
      !> Whether the case is also solved on coarser meshes, for an estimate of the discretisation error.
      logical :: error_estimate = .false.
      !> Whether the case is run once more with perturbed friction, to measure its sensitivity to round-off.
      logical :: sensitivity = .false.
      !> Minutes of wall clock between checkpoints; 0: only when the run is interrupted.
      real(wp) :: checkpoint_minutes = 0.0_wp
      !> Names of the user's units, for labels and check_moduli.
      character(:), allocatable :: length_unit, force_unit
   contains
      procedure :: explain
      procedure :: check_moduli
   end type case_type

contains

   !> Put the file, the step and the targets that were not reached before the message of a simulation that ended early.
   subroutine explain(self, simulation)
      class(case_type), intent(in) :: self
      type(simulation_type), intent(inout) :: simulation
      character(:), allocatable :: text
      integer :: i

      text = self%source//': '
      if (simulation%failed_scene_step > 0) then
         associate (step => self%scene%steps(simulation%failed_scene_step))
            if (step%row == 0) text = text//'&step '//to_text(simulation%failed_scene_step)
            if (step%row > 0) text = text//'&history'
            if (step%row > 0 .and. .not. allocated(step%path)) text = text//' row '//to_text(step%row)
            do i = 1, motion_count
               if (step%control(i) == control_keep .or. allocated(step%path)) cycle
               text = text//' '//trim(controlled_key(i, step%control(i)))//'='//to_text(step%target(i), 10)
            end do
         end associate
         text = text//' not reached: '
      end if
      simulation%message = text//simulation%message
   end subroutine explain

   !> Warn of bodies that are stiffer than any material by the names of the units, such as moduli in Pa beside mm and N.
   subroutine check_moduli(self, warnings)
      class(case_type), intent(in) :: self
      type(string_type), allocatable, intent(inout) :: warnings(:)
      character(len=2), parameter :: forces(5) = [character(len=2) :: 'N', 'kN', 'MN', 'mN', 'uN']
      real(wp), parameter :: newtons(5) = [1.0_wp, 1.0e3_wp, 1.0e6_wp, 1.0e-3_wp, 1.0e-6_wp]
      real(wp) :: metres
      integer :: force

      metres = metres_in(self%length_unit)
      force = findloc(forces == self%force_unit, .true., dim=1)
      if (force == 0 .or. .not. metres > 0.0_wp) return
      call check_body('lower', self%scene%lower)
      call check_body('upper', self%scene%upper)

   contains

      subroutine check_body(name, body)
         character(*), intent(in) :: name
         type(body_type), intent(in) :: body
         !> E* of diamond is 1.1e12 Pa.
         real(wp), parameter :: stiffest = 2.0e12_wp
         real(wp) :: modulus, pascals
         integer :: i

         modulus = maxval([(modulus_of(body%elasticity%material_of(i)), i=1, body%elasticity%layer_count() + 1)])
         pascals = modulus*newtons(force)/metres**2
         if (.not. pascals > stiffest) return
         call add_text(warnings, 'the '//name//' body, or a layer of it, has a contact modulus E* of '//to_text(modulus, 2)// &
                       ' '//self%force_unit//'/'//self%length_unit//'^2, which is '//to_text(pascals, 2)//' Pa, '// &
                       'more than that of diamond: check the units of its moduli; a rigid body has rigid=.true.')
      end subroutine check_body
   end subroutine check_moduli

   !> The contact modulus E* of a material, force/length^2; 0 without one.
   elemental real(wp) function modulus_of(material)
      type(material_type), intent(in) :: material
      type(near_field_type) :: constants

      constants = near_field_of(material)
      modulus_of = 2.0_wp*constants%modulus()
   end function modulus_of

end module mfv_case
