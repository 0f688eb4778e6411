!> A linear solver against the augmented system: single solves of given statuses, and whole runs.
module test_solver_comparison
   use mfv_augmented_system, only: augmented_system_type
   use mfv_body
   use mfv_contact_fields, only: contact_fields_type, new_contact_fields
   use mfv_contact_model, only: contact_model_type
   use mfv_contact_system
   use mfv_friction_law, only: friction_row_type
   use mfv_kinds, only: wp
   use mfv_motions, only: motion_approach, motion_shift, motion_rotation, control_force, control_displacement
   use mfv_node_status
   use mfv_scene
   use mfv_simulation, only: history_none, new_simulation, simulation_type
   implicit none
   private
   public :: partly_stuck, add_fronts, difference, compare_solves, compare_runs, uneven_matrix_body, force, mu

   real(wp), parameter :: force = 1.0e-3_wp, mu = 0.7_wp

contains

   !> Contact from one sixth to five sixths of the mesh, `stuck`: slip of the lower surface to the left, stick, slip to the
   !> right; otherwise all stick except every fifth node. The loads are forces with given rates.
   subroutine partly_stuck(model, stuck, constraints)
      type(contact_model_type), intent(in) :: model
      logical, intent(in) :: stuck
      type(constraints_type), intent(out) :: constraints
      integer :: i, n

      n = model%nodes()
      allocate (constraints%status(n), source=node_open)
      allocate (constraints%row(n))
      allocate (constraints%stuck_slip(n), constraints%offset_rate(n), source=0.0_wp)
      do i = n/6, n - n/6
         constraints%status(i) = node_stick
         if (stuck .and. i < n/3) constraints%status(i) = node_slip_left
         if (stuck .and. i > n - n/4) constraints%status(i) = node_slip_right
         if (.not. stuck .and. modulo(i, 5) == 0) constraints%status(i) = node_slip_left
         constraints%row(i)%slope = -mu*slip_sign(constraints%status(i))
         constraints%row(i)%offset = 1.0e-4_wp*slip_sign(constraints%status(i))
         constraints%offset_rate(i) = 0.3_wp*slip_sign(constraints%status(i))
         constraints%stuck_slip(i) = 1.0e-6_wp*cos(7.0_wp*i/n)
      end do
      constraints%load(motion_approach) = load_type(control_force, force, 0.7_wp*force)
      constraints%load(motion_shift) = load_type(control_force, 0.2_wp*force, 0.4_wp*force)
      constraints%load(motion_rotation) = load_type(control_displacement)
   end subroutine partly_stuck

   !> The two outermost nodes of every stick zone hold in part at the slip of the node beyond it. `opened`: slipping nodes open
   !> first.
   subroutine add_fronts(constraints, opened)
      type(constraints_type), intent(inout) :: constraints
      logical, intent(in) :: opened
      real(wp), parameter :: weight(2) = [0.6_wp, 0.2_wp]
      integer :: i, j

      if (.not. allocated(constraints%front)) allocate (constraints%front(size(constraints%status)))
      constraints%front = front_type()
      if (opened) then
         where (slips(constraints%status))
            constraints%status = node_open
            constraints%row = friction_row_type()
            constraints%offset_rate = 0.0_wp
         end where
      end if
      associate (stuck => constraints%status == node_stick, front => constraints%front)
         do i = 3, size(stuck) - 2
            if (stuck(i)) cycle
            do j = 1, 2
               if (all(stuck(i + 1:i + j))) front(i + j) = front_type(i, weight(j))
               if (all(stuck(i - j:i - 1))) front(i - j) = front_type(i, weight(j))
            end do
         end do
      end associate
   end subroutine add_fronts

   !> Largest difference of the tractions, displacements and motions of two fields, relative to the largest of each kind.
   pure real(wp) function difference(one, other)
      type(contact_fields_type), intent(in) :: one, other

      difference = max(maxval(abs(one%pressure - other%pressure)), maxval(abs(one%shear - other%shear))) &
                   /max(maxval(abs(one%pressure)), maxval(abs(one%shear)))
      difference = max(difference, max(maxval(abs(one%normal - other%normal)), maxval(abs(one%tangential - other%tangential)), &
                                       abs(one%motion(motion_approach) - other%motion(motion_approach)), &
                                       abs(one%motion(motion_shift) - other%motion(motion_shift))) &
                       /max(maxval(abs(one%normal)), abs(one%motion(motion_approach))))
      difference = max(difference, max(abs(one%force(motion_approach) - other%force(motion_approach)), &
                                       abs(one%force(motion_shift) - other%force(motion_shift))) &
                       /max(abs(one%force(motion_approach)), abs(one%force(motion_shift))))
   end function difference

   !> Difference of a solver's solution from that of the augmented system, from a zero guess and again from the solution; huge
   !> if one of them has none.
   subroutine compare_solves(system, model, constraints, largest)
      class(contact_system_type), intent(inout) :: system
      type(contact_model_type), intent(in) :: model
      type(constraints_type), intent(in) :: constraints
      real(wp), intent(out) :: largest
      type(augmented_system_type) :: augmented
      type(response_type) :: expected, found
      type(contact_fields_type) :: start
      logical :: singular, fails

      largest = huge(1.0_wp)
      call augmented%solve(model, constraints, new_contact_fields(model%nodes()), expected, singular)
      call system%solve(model, constraints, new_contact_fields(model%nodes()), found, fails)
      if (singular .or. fails) return
      largest = max(difference(expected%state, found%state), difference(expected%rate, found%rate))
      start = found%state
      call system%solve(model, constraints, start, found, fails)
      if (fails) largest = huge(1.0_wp)
      if (fails) return
      largest = max(largest, difference(expected%state, found%state), difference(expected%rate, found%rate))
   end subroutine compare_solves

   !> Run the scene with dgesv and with another linear solver: events of both, and the largest difference of tractions over
   !> the largest pressure; huge for different outcomes.
   subroutine compare_runs(scene, linear_solver, tolerance, events, largest)
      type(scene_type), intent(in) :: scene
      integer, intent(in) :: linear_solver
      real(wp), intent(in) :: tolerance
      integer, intent(out) :: events(2)
      real(wp), intent(out) :: largest
      type(scene_type) :: other
      type(simulation_type) :: reference, simulation

      other = scene
      other%method%linear_solver = solver_dgesv
      reference = new_simulation(other, history_none)
      call reference%run()
      other%method%linear_solver = linear_solver
      other%method%linear_tolerance = tolerance
      simulation = new_simulation(other, history_none)
      call simulation%run()
      events = [reference%contact%events, simulation%contact%events]
      largest = huge(1.0_wp)
      if (reference%outcome /= simulation%outcome .or. reference%steps_done /= simulation%steps_done) return
      associate (a => reference%contact%state%fields, b => simulation%contact%state%fields)
         if (size(a%pressure) /= size(b%pressure)) return
         largest = max(maxval(abs(a%pressure - b%pressure)), maxval(abs(a%shear - b%shear))) &
                   /max(maxval(a%pressure), tiny(1.0_wp))
      end associate
   end subroutine compare_runs

   !> A user's matrix, that of a half-plane with `n` intervals between one and three widths: no Toeplitz matrix.
   function uneven_matrix_body(n) result(body)
      integer, intent(in) :: n
      type(body_type) :: body
      real(wp) :: position(n), width(n), matrix(2*n, 2*n), end
      integer :: i, j

      end = 0.0_wp
      do i = 1, n
         width(i) = 4.0e-4_wp*(2.0_wp + sin(0.1_wp*i))
         position(i) = end + 0.5_wp*width(i)
         end = end + width(i)
      end do
      position = position - 0.5_wp*end
      do j = 1, n
         do i = 1, n
            matrix(i, j) = 6.0_wp - log(abs(position(i) - position(j)) + 0.2_wp*sqrt(width(i)*width(j)))
            matrix(n + i, n + j) = matrix(i, j)
            matrix(i, n + j) = sign(merge(0.4_wp, 0.0_wp, i /= j), real(i - j, wp))
            matrix(n + j, i) = matrix(i, n + j)
         end do
      end do
      body = new_matrix_body(position, 0.0_wp*position, width, matrix)
   end function uneven_matrix_body

end module test_solver_comparison
