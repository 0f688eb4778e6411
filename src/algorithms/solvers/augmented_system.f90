!> The augmented system of dissertation eq. 2.2, solved by LAPACK's dgesv: the reference linear solver.
!>
!> Included are the nodes in contact and their open neighbours. Unknowns, for m included nodes: pressures p, shear tractions tau, w
!> - delta, s = u - U, and delta, U, P, Q; 4m + 4 in all (4n + 12 for one patch of n contact nodes). Rows: elasticity, force
!> balance (eq. 2.1), one normal and one tangential constraint for each node (Table 2.1), and the two controlled loads. If no node
!> has shear (friction off or absent), tau, s, U and Q are omitted: 2m + 2. If rotation (or another motion) is modelled, it and the
!> moment are added (eq. 4.24); w and s then include its effect.
!>
!> The unknowns are scaled by the modulus of the compliance and the length of the mesh, so that units do not matter; shear also by
!> a small mu. One factorisation serves two right-hand sides, the state and its rates, and their iterative refinement: each row is
!> then satisfied up to round-off of its own terms (Skeel, Math. Comp. 35, 1980), also the balance of forces that are tiny beside
!> the units, as where contact begins at a single node.
module mfv_augmented_system
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use mfv_compliance, only: block_up, block_ut, block_wp, block_wt, compliance_type
   use mfv_contact_fields, only: contact_fields_type, new_contact_fields
   use mfv_contact_model, only: contact_model_type
   use mfv_contact_system
   use mfv_kinds, only: wp
   use mfv_lapack, only: dgesv, dgetrs
   use mfv_motions, only: motion_count, motion_shift, motion_rotation, control_force
   use mfv_node_status
   implicit none
   private
   public :: augmented_system_type

   type, extends(contact_system_type) :: augmented_system_type
   contains
      procedure :: solve
   end type augmented_system_type

   !> The scaled matrix with its two right-hand sides (state, rates), and the positions of the unknowns.
   type :: assembly_type
      !> Included nodes.
      integer, allocatable :: nodes(:)
      !> Whether tau, s, U and Q are unknowns.
      logical :: tangential = .false.
      real(wp), allocatable :: matrix(:, :), right(:, :)
      !> Number of unknowns before those of the first included node, by field; and positions of motions and forces, 0 for those
      !> that are not unknowns.
      integer :: pressure = 0, shear = 0, normal = 0, slip = 0
      integer :: motion(motion_count) = 0, force(motion_count) = 0
      !> With vertical normals the unknown at the position of the shift U is the sliding U + h phi, which is small if the bodies
      !> roll and U and h phi nearly cancel. h: height of the centre of rotation, length; else 0.
      real(wp) :: height = 0.0_wp
      !> Units of pressure, shear traction and length; of the arms, motions and forces.
      real(wp) :: stress = 1.0_wp, shear_stress = 1.0_wp, length = 1.0_wp
      real(wp) :: arm(motion_count) = 1.0_wp, motion_unit(motion_count) = 1.0_wp, force_unit(motion_count) = 1.0_wp
   end type assembly_type

contains

   !> See mfv_contact_system.
   subroutine solve(self, model, constraints, start, response, singular)
      class(augmented_system_type), intent(inout) :: self
      type(contact_model_type), intent(in) :: model
      type(constraints_type), intent(in) :: constraints
      type(contact_fields_type), intent(in) :: start
      type(response_type), intent(inout) :: response
      logical, intent(out) :: singular
      type(assembly_type) :: assembly
      type(prescribed_type) :: state, rate
      integer :: i

      call find_prescribed(constraints, model, .false., state)
      call find_prescribed(constraints, model, .true., rate)
      assembly = new_assembly(model, constraints%status)
      call add_elasticity(assembly, model, [state%load(motion_shift), rate%load(motion_shift)])
      do i = 1, motion_count
         if (assembly%motion(i) > 0) call add_motion(assembly, model, i)
      end do
      call add_normal_constraints(assembly, constraints%status, state, rate)
      if (assembly%tangential) call add_tangential_constraints(assembly, constraints, state, rate)
      call add_loads(assembly, constraints%load)

      self%solves = self%solves + 1
      call solve_and_refine(assembly%matrix, assembly%right, singular)
      if (singular) return
      response%state = extracted(assembly, model, constraints%status, state%load, assembly%right(:, 1))
      response%rate = extracted(assembly, model, constraints%status, rate%load, assembly%right(:, 2))
   end subroutine solve

   !> Solve a system for two right-hand sides, which become the solutions; `matrix` becomes its factors. `singular`: no solution.
   subroutine solve_and_refine(matrix, right, singular)
      real(wp), intent(inout) :: matrix(:, :), right(:, :)
      logical, intent(out) :: singular
      real(wp), allocatable :: original(:, :), residual(:, :)
      integer :: info, n, pivots(size(matrix, 1))

      n = size(matrix, 1)
      original = matrix
      residual = right
      call dgesv(n, 2, matrix, n, pivots, right, n, info)
      singular = info /= 0
      if (.not. singular) singular = .not. all(ieee_is_finite(right))
      if (singular) return
      residual = residual - matmul(original, right)
      call dgetrs('N', n, 2, matrix, n, pivots, residual, n, info)
      right = right + residual
   end subroutine solve_and_refine

   !> An empty assembly for the nodes in contact and their neighbours.
   type(assembly_type) function new_assembly(model, status) result(assembly)
      type(contact_model_type), intent(in) :: model
      integer, intent(in) :: status(:)
      logical :: included(size(status))
      integer :: i, m, n

      n = size(status)
      included = in_contact(status)
      included(2:) = included(2:) .or. in_contact(status(:n - 1))
      included(:n - 1) = included(:n - 1) .or. in_contact(status(2:))
      assembly%nodes = pack([(i, i=1, n)], included)
      assembly%tangential = any(holds(status) .or. slips(status))
      assembly%stress = model%compliance%modulus
      assembly%length = model%length()
      assembly%shear_stress = assembly%stress
      if (assembly%tangential) assembly%shear_stress = assembly%stress*model%friction_scale
      assembly%arm = model%unit_of_arm([(i, i=1, motion_count)])
      assembly%motion_unit = assembly%length/assembly%arm
      assembly%force_unit = assembly%stress*(assembly%length*assembly%arm)
      assembly%force_unit(motion_shift) = assembly%shear_stress*assembly%length

      m = size(assembly%nodes)
      assembly%normal = m
      n = 2*m
      do i = 1, motion_count
         if (.not. model%moves(i) .or. (i == motion_shift .and. .not. assembly%tangential)) cycle
         if (i == motion_shift) then
            assembly%shear = n
            assembly%slip = n + m
            n = n + 2*m
         end if
         assembly%motion(i) = n + 1
         assembly%force(i) = n + 2
         n = n + 2
      end do
      if (model%moves(motion_rotation) .and. assembly%tangential .and. model%upright) assembly%height = model%centre_height()
      allocate (assembly%matrix(n, n), assembly%right(n, 2), source=0.0_wp)
   end function new_assembly

   !> Rows of eq. 2.1, (w - delta) + delta - C_wp p - C_wt tau = 0 and s + U - C_up p - C_ut tau = 0, except for the motions (see
   !> add_motion). A `shift` (and its rate) that is not an unknown is on the right side.
   subroutine add_elasticity(assembly, model, shift)
      type(assembly_type), intent(inout) :: assembly
      type(contact_model_type), intent(in) :: model
      real(wp), intent(in) :: shift(2)
      integer :: i

      associate (pressure => assembly%pressure, shear => assembly%shear, compliance => model%compliance)
         call add_block(assembly, compliance, block_wp, pressure, pressure, assembly%stress)
         do i = 1, size(assembly%nodes)
            assembly%matrix(pressure + i, assembly%normal + i) = 1.0_wp
            if (assembly%tangential) then
               assembly%matrix(shear + i, assembly%slip + i) = 1.0_wp
            else
               assembly%right(pressure + i, :) = -model%normal_arm(assembly%nodes(i), motion_shift)*shift/assembly%length
            end if
         end do
         if (.not. assembly%tangential) return
         call add_block(assembly, compliance, block_wt, pressure, shear, assembly%shear_stress)
         call add_block(assembly, compliance, block_up, shear, pressure, assembly%stress)
         call add_block(assembly, compliance, block_ut, shear, shear, assembly%shear_stress)
      end associate
   end subroutine add_elasticity

   !> Subtract a compliance block from the rows after `row` and the columns after `column`, of tractions in `unit`.
   subroutine add_block(assembly, compliance, block, row, column, unit)
      type(assembly_type), intent(inout) :: assembly
      class(compliance_type), intent(in) :: compliance
      integer, intent(in) :: block, row, column
      real(wp), intent(in) :: unit
      integer :: m
      real(wp), allocatable :: entries(:, :)

      if (.not. compliance%has_block(block)) return
      m = size(assembly%nodes)
      allocate (entries(m, m))
      call compliance%entries(block, assembly%nodes, assembly%nodes, entries)
      assembly%matrix(row + 1:row + m, column + 1:column + m) = -(unit/assembly%length)*entries
   end subroutine add_block

   !> A motion in the elasticity rows; in its own row the balance of its force with the tractions: sum(p) dx - P = 0,
   !> sum(tau) dx - Q = 0, and eq. 4.24 of the rotation: with vertical normals the moment of the shear is h Q.
   subroutine add_motion(assembly, model, motion)
      type(assembly_type), intent(inout) :: assembly
      type(contact_model_type), intent(in) :: model
      integer, intent(in) :: motion
      integer :: m

      m = size(assembly%nodes)
      associate (row => assembly%motion(motion), pressure => assembly%pressure, shear => assembly%shear, nodes => assembly%nodes, &
                 arm => assembly%arm(motion), stress => merge(assembly%shear_stress, assembly%stress, motion == motion_shift))
         associate (weight => model%width(nodes)/assembly%length/arm/stress)
            assembly%matrix(row, pressure + 1:pressure + m) = weight*model%normal_arm(nodes, motion)*assembly%stress
            assembly%matrix(row, assembly%force(motion)) = -1.0_wp
            assembly%matrix(pressure + 1:pressure + m, row) = model%normal_arm(nodes, motion)/arm
            if (.not. assembly%tangential) return
            if (motion == motion_rotation .and. model%upright) then
               assembly%matrix(row, assembly%force(motion_shift)) = assembly%height*assembly%shear_stress/(assembly%stress*arm)
            else
               assembly%matrix(row, shear + 1:shear + m) = weight*model%tangential_arm(nodes, motion)*assembly%shear_stress
               assembly%matrix(shear + 1:shear + m, row) = model%tangential_arm(nodes, motion)/arm
            end if
         end associate
      end associate
   end subroutine add_motion

   !> Rows w - delta = -g0 for nodes in contact, p = 0 for open ones.
   subroutine add_normal_constraints(assembly, status, state, rate)
      type(assembly_type), intent(inout) :: assembly
      integer, intent(in) :: status(:)
      type(prescribed_type), intent(in) :: state, rate
      integer :: i, row

      do i = 1, size(assembly%nodes)
         row = assembly%normal + i
         associate (node => assembly%nodes(i))
            if (in_contact(status(node))) then
               assembly%matrix(row, assembly%normal + i) = 1.0_wp
               assembly%right(row, :) = [state%opening(node), rate%opening(node)]/assembly%length
            else
               assembly%matrix(row, assembly%pressure + i) = 1.0_wp
            end if
         end associate
      end do
   end subroutine add_normal_constraints

   !> Rows s = s0 for stuck nodes, at a front s - weight*s(outer) = s0, tau - slope*p - stiffness*s = offset for slipping and
   !> creeping ones, tau = 0 for the others; divided by their largest coefficient.
   subroutine add_tangential_constraints(assembly, constraints, state, rate)
      type(assembly_type), intent(inout) :: assembly
      type(constraints_type), intent(in) :: constraints
      type(prescribed_type), intent(in) :: state, rate
      integer :: i, node, outer, row
      real(wp) :: slope, stiffness, unit

      do i = 1, size(assembly%nodes)
         row = assembly%slip + i
         node = assembly%nodes(i)
         if (constraints%status(node) == node_stick) then
            assembly%matrix(row, assembly%slip + i) = 1.0_wp
            assembly%right(row, :) = [state%slip(node), rate%slip(node)]/assembly%length
            if (.not. allocated(constraints%front)) cycle
            if (constraints%front(node)%node == 0) cycle
            outer = findloc(assembly%nodes, constraints%front(node)%node, dim=1)
            assembly%matrix(row, assembly%slip + outer) = -constraints%front(node)%weight
         else if (slips(constraints%status(node)) .or. creeps(constraints%status(node))) then
            slope = constraints%row(node)%slope*assembly%stress/assembly%shear_stress
            stiffness = constraints%row(node)%stiffness*assembly%length/assembly%shear_stress
            unit = max(1.0_wp, abs(slope), abs(stiffness))
            assembly%matrix(row, assembly%shear + i) = 1.0_wp/unit
            assembly%matrix(row, assembly%pressure + i) = -slope/unit
            assembly%matrix(row, assembly%slip + i) = -stiffness/unit
            assembly%right(row, :) = [state%offset(node), rate%offset(node)]/assembly%shear_stress/unit
         else
            assembly%matrix(row, assembly%shear + i) = 1.0_wp
         end if
      end do
   end subroutine add_tangential_constraints

   !> Rows that prescribe P or delta, Q or U, M or the rotation, at the positions of the forces.
   subroutine add_loads(assembly, load)
      type(assembly_type), intent(inout) :: assembly
      type(load_type), intent(in) :: load(motion_count)
      integer :: i

      do i = 1, motion_count
         if (assembly%motion(i) == 0) cycle
         associate (row => assembly%force(i))
            if (load(i)%control == control_force) then
               assembly%matrix(row, row) = 1.0_wp
               assembly%right(row, :) = [load(i)%value, load(i)%rate]/assembly%force_unit(i)
            else
               assembly%matrix(row, assembly%motion(i)) = 1.0_wp
               assembly%right(row, :) = [load(i)%value, load(i)%rate]/assembly%motion_unit(i)
            end if
         end associate
      end do
      if (abs(assembly%height) > 0.0_wp .and. load(motion_shift)%control /= control_force) &
         assembly%matrix(assembly%force(motion_shift), assembly%motion(motion_rotation)) = -assembly%height/assembly%length
   end subroutine add_loads

   !> Fields from a scaled solution. `load`: prescribed loads. All displacements are those of the tractions: the unknowns w - delta
   !> and s have the round-off of the motions, which can be larger than the displacements of a contact that begins.
   type(contact_fields_type) function extracted(assembly, model, status, load, solution) result(fields)
      type(assembly_type), intent(in) :: assembly
      type(contact_model_type), intent(in) :: model
      integer, intent(in) :: status(:)
      real(wp), intent(in) :: load(motion_count), solution(:)
      integer :: i, m

      m = size(assembly%nodes)
      fields = new_contact_fields(size(status))
      do i = 1, motion_count
         if (assembly%motion(i) == 0) cycle
         fields%motion(i) = assembly%motion_unit(i)*solution(assembly%motion(i))
         fields%force(i) = assembly%force_unit(i)*solution(assembly%force(i))
      end do
      associate (nodes => assembly%nodes)
         fields%pressure(nodes) = assembly%stress*solution(assembly%pressure + 1:assembly%pressure + m)
         where (.not. in_contact(status)) fields%pressure = 0.0_wp
         if (assembly%tangential) then
            fields%motion(motion_shift) = fields%motion(motion_shift) - assembly%height*fields%motion(motion_rotation)
            fields%shear(nodes) = assembly%shear_stress*solution(assembly%shear + 1:assembly%shear + m)
            where (.not. in_contact(status)) fields%shear = 0.0_wp
         else
            ! Inclined normals give a tangential resultant even without friction.
            fields%motion(motion_shift) = load(motion_shift)
            fields%force(motion_shift) = model%resultant(motion_shift, fields%pressure, fields%shear)
         end if
      end associate
      call model%displace(fields)
   end function extracted

end module mfv_augmented_system
