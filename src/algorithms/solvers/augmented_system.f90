!> The augmented system of dissertation eq. 2.2, solved by LAPACK's dgesv: the reference among the linear solvers.
!>
!> Carried are the nodes in contact and their open neighbours. Unknowns, for m carried nodes: pressures p, shear
!> tractions tau, w - delta, s = u - U, and delta, U, P, Q; 4m + 4 in all (4n + 12 for one patch of n contact nodes).
!> Rows: elasticity, force balance (eq. 2.1), one normal and one tangential constraint a node (Table 2.1), and the two
!> controlled loads. While no node can carry shear (friction off or absent), tau, s, U and Q are left out: 2m + 2.
!> Where rotation (or another motion) is modelled it and the moment come as well (eq. 4.24): w and s then contain what it does.
!>
!> The unknowns are scaled by the compliance's modulus and the mesh's length, so that units do not matter, and shear also
!> by mu where that is small. One
!> factorisation serves two right-hand sides: the state and its rates.
module mfv_augmented_system
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use mfv_compliance, only: block_up, block_ut, block_wp, block_wt, compliance_type
   use mfv_contact_fields, only: contact_fields_type, new_contact_fields
   use mfv_contact_model, only: contact_model_type
   use mfv_contact_system
   use mfv_kinds, only: wp
   use mfv_lapack, only: dgesv
   use mfv_motions, only: motions, motion_count, motion_approach, motion_shift, motion_rotation, control_force, arm_unit
   use mfv_node_status
   implicit none
   private
   public :: augmented_system_type

   type, extends(contact_system_type) :: augmented_system_type
   contains
      procedure :: solve
   end type augmented_system_type

   !> The scaled matrix with its two right-hand sides (state, rates), and where the unknowns are.
   type :: assembly_type
      !> Carried nodes.
      integer, allocatable :: nodes(:)
      !> Whether tau, s, U and Q are unknowns.
      logical :: tangential = .false.
      real(wp), allocatable :: matrix(:, :), right(:, :)
      !> Unknowns before those of the first carried node, by field; and places of the scalars.
      integer :: pressure = 0, shear = 0, normal = 0, slip = 0
      integer :: motion(motion_count) = 0, force(motion_count) = 0
      !> Where normals are vertical the unknown in the place of the shift U is the sliding U + h phi, which is small where the bodies
      !> roll and U and h phi nearly cancel: the height h of the centre of rotation, length; else 0.
      real(wp) :: height = 0.0_wp
      !> Units of pressure, shear traction and length.
      real(wp) :: stress = 1.0_wp, shear_stress = 1.0_wp, length = 1.0_wp
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
      integer, allocatable :: pivots(:)
      integer :: i, info, n

      assembly = new_assembly(model, constraints%status)
      call add_elasticity(assembly, model, constraints%load(motion_shift))
      call add_force_balance(assembly, model)
      do i = 1, motion_count
         if (motions(i)%optional .and. model%moves(i)) call add_motion(assembly, model, i)
      end do
      call add_normal_constraints(assembly, model, constraints)
      if (assembly%tangential) call add_tangential_constraints(assembly, model, constraints)
      call add_loads(assembly, constraints)

      n = size(assembly%matrix, 1)
      allocate (pivots(n))
      call dgesv(n, 2, assembly%matrix, n, pivots, assembly%right, n, info)
      self%solves = self%solves + 1
      singular = info /= 0
      if (.not. singular) singular = .not. all(ieee_is_finite(assembly%right))
      if (singular) return
      response%state = extracted(assembly, constraints%status, assembly%right(:, 1))
      response%rate = extracted(assembly, constraints%status, assembly%right(:, 2))
      if (.not. assembly%tangential) then
         response%state%motion(motion_shift) = constraints%load(motion_shift)%value
         response%rate%motion(motion_shift) = constraints%load(motion_shift)%rate
      end if
      if (.not. assembly%tangential) call add_leaning_force(response, model)
      call fill_displacements(response%state, model, assembly)
      call fill_displacements(response%rate, model, assembly)
   end subroutine solve

   !> Without friction leaning normals carry a tangential force all the same.
   subroutine add_leaning_force(response, model)
      type(response_type), intent(inout) :: response
      type(contact_model_type), intent(in) :: model

      associate (state => response%state, rate => response%rate)
         state%force(motion_shift) = model%resultant(motion_shift, state%pressure, state%shear)
         rate%force(motion_shift) = model%resultant(motion_shift, rate%pressure, rate%shear)
      end associate
   end subroutine add_leaning_force

   !> An assembly of zeros for the nodes in contact and their neighbours.
   function new_assembly(model, status) result(assembly)
      type(contact_model_type), intent(in) :: model
      integer, intent(in) :: status(:)
      type(assembly_type) :: assembly
      logical :: carried(size(status))
      integer :: i, m, n

      n = size(status)
      carried = in_contact(status)
      carried(2:) = carried(2:) .or. in_contact(status(:n - 1))
      carried(:n - 1) = carried(:n - 1) .or. in_contact(status(2:))
      assembly%nodes = pack([(i, i=1, n)], carried)
      assembly%tangential = any(holds(status) .or. slips(status))
      assembly%stress = model%compliance%modulus
      assembly%length = model%length()
      assembly%shear_stress = assembly%stress
      if (assembly%tangential) assembly%shear_stress = assembly%stress*model%grip

      m = size(assembly%nodes)
      assembly%pressure = 0
      assembly%normal = m
      assembly%motion(motion_approach) = 2*m + 1
      assembly%force(motion_approach) = 2*m + 2
      n = 2*m + 2
      if (assembly%tangential) then
         assembly%shear = n
         assembly%slip = n + m
         assembly%motion(motion_shift) = n + 2*m + 1
         assembly%force(motion_shift) = n + 2*m + 2
         n = n + 2*m + 2
      end if
      if (model%moves(motion_rotation) .and. assembly%tangential .and. model%upright) assembly%height = model%centre_height()
      do i = 1, motion_count
         if (.not. (motions(i)%optional .and. model%moves(i))) cycle
         assembly%motion(i) = n + 1
         assembly%force(i) = n + 2
         n = n + 2
      end do
      allocate (assembly%matrix(n, n), assembly%right(n, 2), source=0.0_wp)
   end function new_assembly

   !> Rows of eq. 2.1: (w - delta) + delta - C_wp p - C_wt tau = 0 and s + U - C_up p - C_ut tau = 0.
   !> Where normals lean, approach and shift are in both; a shift that is no unknown comes on the right.
   subroutine add_elasticity(assembly, model, shift)
      type(assembly_type), intent(inout) :: assembly
      type(contact_model_type), intent(in) :: model
      type(load_type), intent(in) :: shift
      integer :: i, m

      m = size(assembly%nodes)
      associate (pressure => assembly%pressure, shear => assembly%shear, compliance => model%compliance, &
                 nodes => assembly%nodes)
         call add_block(assembly, compliance, block_wp, pressure, pressure, assembly%stress)
         do i = 1, m
            assembly%matrix(pressure + i, assembly%normal + i) = 1.0_wp
            assembly%matrix(pressure + i, assembly%motion(motion_approach)) = model%normal_arm(nodes(i), motion_approach)
            if (assembly%tangential) then
               assembly%matrix(pressure + i, assembly%motion(motion_shift)) = model%normal_arm(nodes(i), motion_shift)
            else
               assembly%right(pressure + i, :) = -model%normal_arm(nodes(i), motion_shift)*[shift%value, shift%rate] &
                                                 /assembly%length
            end if
         end do
         if (.not. assembly%tangential) return
         call add_block(assembly, compliance, block_wt, pressure, shear, assembly%shear_stress)
         call add_block(assembly, compliance, block_up, shear, pressure, assembly%stress)
         call add_block(assembly, compliance, block_ut, shear, shear, assembly%shear_stress)
         do i = 1, m
            assembly%matrix(shear + i, assembly%slip + i) = 1.0_wp
            assembly%matrix(shear + i, assembly%motion(motion_shift)) = model%tangential_arm(nodes(i), motion_shift)
            assembly%matrix(shear + i, assembly%motion(motion_approach)) = model%tangential_arm(nodes(i), motion_approach)
         end do
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

   !> Rows sum(p) dx - P = 0 and sum(tau) dx - Q = 0, in the rows of the rigid motions.
   subroutine add_force_balance(assembly, model)
      type(assembly_type), intent(inout) :: assembly
      type(contact_model_type), intent(in) :: model

      call add_resultant(assembly, model, motion_approach, assembly%stress, 1.0_wp)
      if (assembly%tangential) call add_resultant(assembly, model, motion_shift, assembly%shear_stress, 1.0_wp)
   end subroutine add_force_balance

   !> A motion besides approach and shift in the elasticity rows, the balance of its force in its own (eq. 4.24 of the rotation:
   !> with vertical normals the moment of the shear is h Q).
   subroutine add_motion(assembly, model, motion)
      type(assembly_type), intent(inout) :: assembly
      type(contact_model_type), intent(in) :: model
      integer, intent(in) :: motion
      real(wp) :: arm
      integer :: m

      m = size(assembly%nodes)
      arm = arm_unit(motion, assembly%length)
      call add_resultant(assembly, model, motion, assembly%stress, arm)
      associate (row => assembly%motion(motion), pressure => assembly%pressure, shear => assembly%shear)
         assembly%matrix(pressure + 1:pressure + m, row) = model%normal_arm(assembly%nodes, motion)/arm
         if (.not. assembly%tangential) return
         if (motion == motion_rotation .and. model%upright) then
            assembly%matrix(row, shear + 1:shear + m) = 0.0_wp
            assembly%matrix(row, assembly%force(motion_shift)) = assembly%height*assembly%shear_stress/(assembly%stress*arm)
         else
            assembly%matrix(shear + 1:shear + m, row) = model%tangential_arm(assembly%nodes, motion)/arm
         end if
      end associate
   end subroutine add_motion

   !> The row of a motion sums up the tractions to its force; `stress`: its unit of stress, `arm`: of arms.
   subroutine add_resultant(assembly, model, motion, stress, arm)
      type(assembly_type), intent(inout) :: assembly
      type(contact_model_type), intent(in) :: model
      integer, intent(in) :: motion
      real(wp), intent(in) :: stress, arm
      integer :: m

      m = size(assembly%nodes)
      associate (weight => model%width(assembly%nodes)/assembly%length/arm/stress, row => assembly%motion(motion))
         assembly%matrix(row, assembly%pressure + 1:assembly%pressure + m) = &
            weight*model%normal_arm(assembly%nodes, motion)*assembly%stress
         assembly%matrix(row, assembly%force(motion)) = -1.0_wp
         if (.not. assembly%tangential) return
         assembly%matrix(row, assembly%shear + 1:assembly%shear + m) = &
            weight*model%tangential_arm(assembly%nodes, motion)*assembly%shear_stress
      end associate
   end subroutine add_resultant

   !> Rows w - delta = -g0 for nodes in contact, p = 0 for open ones.
   subroutine add_normal_constraints(assembly, model, constraints)
      type(assembly_type), intent(inout) :: assembly
      type(contact_model_type), intent(in) :: model
      type(constraints_type), intent(in) :: constraints
      integer :: i, row

      do i = 1, size(assembly%nodes)
         row = assembly%normal + i
         if (in_contact(constraints%status(assembly%nodes(i)))) then
            assembly%matrix(row, assembly%normal + i) = 1.0_wp
            assembly%right(row, 1) = -model%initial_gap(assembly%nodes(i))/assembly%length
            if (allocated(constraints%gap_rate)) &
               assembly%right(row, 2) = constraints%gap_rate(assembly%nodes(i))/assembly%length
         else
            assembly%matrix(row, assembly%pressure + i) = 1.0_wp
         end if
      end do
   end subroutine add_normal_constraints

   !> Rows s = s0 for stuck nodes, tau - slope*p - stiffness*s = offset for slipping and creeping ones, tau = 0 for the
   !> others; divided by what is largest in them.
   subroutine add_tangential_constraints(assembly, model, constraints)
      type(assembly_type), intent(inout) :: assembly
      type(contact_model_type), intent(in) :: model
      type(constraints_type), intent(in) :: constraints
      integer :: i, node, row
      real(wp) :: slope, stiffness, unit

      do i = 1, size(assembly%nodes)
         row = assembly%slip + i
         node = assembly%nodes(i)
         if (constraints%status(node) == node_stick) then
            assembly%matrix(row, assembly%slip + i) = 1.0_wp
            assembly%right(row, 1) = constraints%stuck_slip(node)/assembly%length
            if (allocated(constraints%slip_rate)) assembly%right(row, 2) = constraints%slip_rate(node)/assembly%length
         else if (slips(constraints%status(node)) .or. creeps(constraints%status(node))) then
            associate (line => constraints%row(node))
               slope = line%slope*assembly%stress/assembly%shear_stress
               stiffness = line%stiffness*assembly%length/assembly%shear_stress
               unit = max(1.0_wp, abs(slope), abs(stiffness))
               assembly%matrix(row, assembly%shear + i) = 1.0_wp/unit
               assembly%matrix(row, assembly%pressure + i) = -slope/unit
               assembly%matrix(row, assembly%slip + i) = -stiffness/unit
               assembly%right(row, :) = [line%offset, constraints%offset_rate(node)]/assembly%shear_stress/unit
            end associate
         else
            assembly%matrix(row, assembly%shear + i) = 1.0_wp
         end if
      end do
   end subroutine add_tangential_constraints

   !> Rows that prescribe P or delta, Q or U, M or the rotation.
   subroutine add_loads(assembly, constraints)
      type(assembly_type), intent(inout) :: assembly
      type(constraints_type), intent(in) :: constraints
      integer :: i

      associate (length => assembly%length)
         call add_load(assembly, constraints, motion_approach, assembly%stress*length, length)
         if (assembly%tangential) call add_load(assembly, constraints, motion_shift, assembly%shear_stress*length, length)
         if (abs(assembly%height) > 0.0_wp .and. constraints%load(motion_shift)%control /= control_force) &
            assembly%matrix(assembly%force(motion_shift), assembly%motion(motion_rotation)) = -assembly%height/length
         do i = 1, motion_count
            if (motions(i)%optional .and. assembly%motion(i) > 0) &
               call add_load(assembly, constraints, i, assembly%stress*(length*arm_unit(i, length)), length/arm_unit(i, length))
         end do
      end associate
   end subroutine add_loads

   !> The row in the force's place: prescribe the force, or the displacement, each with its unit.
   subroutine add_load(assembly, constraints, motion, force_unit, displacement_unit)
      type(assembly_type), intent(inout) :: assembly
      type(constraints_type), intent(in) :: constraints
      integer, intent(in) :: motion
      real(wp), intent(in) :: force_unit, displacement_unit
      real(wp) :: unit

      associate (load => constraints%load(motion), row => assembly%force(motion))
         if (load%control == control_force) then
            unit = force_unit
            assembly%matrix(row, row) = 1.0_wp
         else
            unit = displacement_unit
            assembly%matrix(row, assembly%motion(motion)) = 1.0_wp
         end if
         assembly%right(row, :) = [load%value, load%rate]/unit
      end associate
   end subroutine add_load

   !> Fields from a scaled solution; displacements of the carried nodes only.
   function extracted(assembly, status, solution) result(fields)
      type(assembly_type), intent(in) :: assembly
      integer, intent(in) :: status(:)
      real(wp), intent(in) :: solution(:)
      type(contact_fields_type) :: fields
      integer :: i, m

      m = size(assembly%nodes)
      fields = new_contact_fields(size(status))
      associate (stress => assembly%stress, length => assembly%length, nodes => assembly%nodes)
         fields%motion(motion_approach) = length*solution(assembly%motion(motion_approach))
         fields%force(motion_approach) = stress*length*solution(assembly%force(motion_approach))
         fields%pressure(nodes) = stress*solution(assembly%pressure + 1:assembly%pressure + m)
         fields%normal(nodes) = length*solution(assembly%normal + 1:assembly%normal + m) + fields%motion(motion_approach)
         where (.not. in_contact(status)) fields%pressure = 0.0_wp
         do i = 1, motion_count
            if (.not. motions(i)%optional .or. assembly%motion(i) == 0) cycle
            fields%motion(i) = length/arm_unit(i, length)*solution(assembly%motion(i))
            fields%force(i) = stress*(length*arm_unit(i, length))*solution(assembly%force(i))
         end do
         if (.not. assembly%tangential) return
         fields%motion(motion_shift) = length*solution(assembly%motion(motion_shift)) &
                                       - assembly%height*fields%motion(motion_rotation)
         fields%force(motion_shift) = assembly%shear_stress*length*solution(assembly%force(motion_shift))
         fields%shear(nodes) = assembly%shear_stress*solution(assembly%shear + 1:assembly%shear + m)
         fields%tangential(nodes) = length*solution(assembly%slip + 1:assembly%slip + m) + fields%motion(motion_shift)
         where (.not. in_contact(status)) fields%shear = 0.0_wp
      end associate
   end function extracted

   !> Displacements that are not among the unknowns, by products with the compliance.
   subroutine fill_displacements(fields, model, assembly)
      type(contact_fields_type), intent(inout) :: fields
      type(contact_model_type), intent(in) :: model
      type(assembly_type), intent(in) :: assembly
      real(wp) :: normal(model%nodes()), tangential(model%nodes())
      logical :: carried(model%nodes())

      call model%relative_displacements(fields, normal, tangential)
      carried = .false.
      carried(assembly%nodes) = .true.
      where (.not. carried) fields%normal = normal
      where (.not. (carried .and. assembly%tangential)) fields%tangential = tangential
   end subroutine fill_displacements

end module mfv_augmented_system
