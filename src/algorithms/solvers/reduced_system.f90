!> The reduced system: unknowns are the pressures of the nodes in contact, the shear tractions of those that stick, slip or creep,
!> and the rigid motions; all others are eliminated from dissertation eq. 2.2.
!>
!> If every node in contact is taken to stick, its matrix is
!>
!>     [  C   -N ]
!>     [ -N'   0 ],    C the compliance between these nodes, N the effect of rigid motions on gap and slip,
!>
!> symmetric by reciprocity (for tractions times the widths of the nodes, where these differ). Its inverse is stored, and updated
!> when nodes enter or leave the contact. Slipping and creeping nodes and displacement control are constraints with an unknown slip
!> or force (mfv_constrained_inverse). A node that begins or ceases to slip then costs a few vector operations, and a reversal,
!> where all nodes stick again, nothing. The unknown slip of a node beside a front also acts on the rows of the nodes that hold at
!> it (front_type); if it is open, it has a shear traction that is constrained to zero. The residuals of all rows are checked after
!> every solve with the full compliance. If they are too large, the solution is refined; if that fails, the inverse is recomputed.
!>
!> Without the effect of shear on the normal problem (Goodman's coupling, none, no friction) the two problems are solved one after
!> the other, each with its own inverse. Goodman's coupling with rotation or radial normals is not symmetric and uses the augmented
!> system.
module mfv_reduced_system
   use mfv_augmented_system, only: augmented_system_type
   use mfv_compliance, only: block_up, block_ut, block_wp, block_wt
   use mfv_constrained_inverse, only: constrained_inverse_type
   use mfv_contact_fields, only: contact_fields_type
   use mfv_contact_model, only: contact_model_type
   use mfv_contact_system
   use mfv_kinds, only: wp
   use mfv_motions, only: motions, motion_count, motion_approach, motion_shift, motion_rotation, control_force, arm_unit
   use mfv_node_status, only: in_contact, node_frictionless, node_stick
   use mfv_tolerances, only: certified, rounding
   implicit none
   private
   public :: reduced_system_type

   !> Types of unknowns: of a node, or of the upper body.
   integer, parameter :: a_pressure = 1, a_shear = 2, a_motion = 3

   !> A subsystem that is solved independently.
   type :: subsystem_type
      type(constrained_inverse_type) :: system
      !> Type of every unknown, and its node or motion; shape (capacity), the first `unknowns` are in use.
      integer :: unknowns = 0
      integer, allocatable :: sort(:), of(:)
      !> Right side and solution of the rows, and values of the constraints.
      real(wp), allocatable :: right(:), solution(:), values(:)
   end type subsystem_type

   !> Magnitudes for relative residuals: normal and tangential displacements, length; tractions, force/length^2; all forces and
   !> tangential ones, force/length.
   type :: scales_type
      real(wp) :: normal = 1.0_wp, tangential = 1.0_wp, traction = 1.0_wp, force = 1.0_wp, shear_force = 1.0_wp
   end type scales_type

   type, extends(contact_system_type) :: reduced_system_type
      private
      !> Normal and tangential problem if uncoupled, else both in the first.
      type(subsystem_type) :: subsystem(2)
      logical :: apart = .false.
      !> Positions of the unknowns of nodes and motions in their subsystem, by type; and numbers of the constraints of their shear
      !> tractions and of the motions; 0: none. Shape (at least nodes and motion_count, types).
      integer, allocatable :: place(:, :), constraint_of(:, :)
      !> Number of nodes that these are for; 0: invalid.
      integer :: nodes = 0
      !> Prescribed values of the fields that are solved for.
      type(prescribed_type) :: prescribed
      !> Unit of length: half the length of the initial mesh; it does not change when the mesh grows. And the units of the arms of
      !> the motions.
      real(wp) :: length = 1.0_wp, arm(motion_count) = 1.0_wp
      !> Blocks and motions of the present inverses.
      logical :: block(4) = .false., moves(motion_count) = .false.
      type(augmented_system_type) :: augmented
      !> Number of refinements.
      integer, public :: refinements = 0
   contains
      procedure :: solve
      procedure :: rebuilds
   end type reduced_system_type

contains

   !> Number of recomputed inverses.
   pure integer function rebuilds(self)
      class(reduced_system_type), intent(in) :: self

      rebuilds = sum(self%subsystem%system%inverse%rebuilds)
   end function rebuilds

   !> See mfv_contact_system.
   subroutine solve(self, model, constraints, start, response, singular)
      class(reduced_system_type), intent(inout) :: self
      type(contact_model_type), intent(in) :: model
      type(constraints_type), intent(in) :: constraints
      type(contact_fields_type), intent(in) :: start
      type(response_type), intent(inout) :: response
      logical, intent(out) :: singular

      self%solves = self%solves + 1
      if (model%compliance%one_way() .and. model%motions_couple()) then
         self%name = self%augmented%name
         call self%augmented%solve(model, constraints, start, response, singular)
         return
      end if
      call match(self, model)
      call respond(self, model, constraints, start, .false., response, singular)
      ! The inverse may be inaccurate: repeat with a new one.
      if (singular .and. .not. undetermined(self, model, constraints)) &
         call respond(self, model, constraints, start, .true., response, singular)
      ! All of a period touches: the pressure that presses an incompressible layer everywhere alike is that of the force alone.
      if (singular .and. model%scene%repeat_length() > 0.0_wp .and. all(in_contact(constraints%status))) &
         call self%augmented%solve(model, constraints, start, response, singular)
   end subroutine solve

   !> State and rates. `recompute`: whether to recompute the inverse.
   subroutine respond(self, model, constraints, start, recompute, response, singular)
      class(reduced_system_type), intent(inout) :: self
      type(contact_model_type), intent(in) :: model
      type(constraints_type), intent(in) :: constraints
      type(contact_fields_type), intent(in) :: start
      logical, intent(in) :: recompute
      type(response_type), intent(inout) :: response
      logical, intent(out) :: singular

      if (recompute) call match(self, model)
      call follow(self, model, constraints, recompute, singular)
      if (.not. singular) singular = undetermined(self, model, constraints)
      if (singular) return
      call spread_slip(self, constraints, .true.)
      call response%state%copy_from(start)
      call refine(self, model, constraints, .false., response%state, singular)
      if (.not. singular) then
         call response%rate%clear(size(constraints%status))
         call refine(self, model, constraints, .true., response%rate, singular)
      end if
      call spread_slip(self, constraints, .false.)
   end subroutine respond

   !> Let the slip of the nodes beside fronts act on the nodes that hold at them, or (not `at_fronts`) no longer.
   subroutine spread_slip(self, constraints, at_fronts)
      class(reduced_system_type), intent(inout) :: self
      type(constraints_type), intent(in) :: constraints
      logical, intent(in) :: at_fronts
      real(wp), allocatable :: weights(:)
      logical :: is_outer(self%nodes)
      integer :: i, outer

      is_outer = beside_front(constraints)
      associate (subsystem => self%subsystem(subsystem_of(self, a_shear, 0)), front => constraints%front)
         allocate (weights(subsystem%unknowns))
         do outer = 1, self%nodes
            if (.not. is_outer(outer)) cycle
            weights = 0.0_wp
            weights(self%place(outer, a_shear)) = 1.0_wp
            do i = 1, self%nodes
               if (at_fronts .and. front(i)%node == outer) weights(self%place(i, a_shear)) = front(i)%weight
            end do
            call subsystem%system%spread(self%constraint_of(outer, a_shear), weights)
         end do
      end associate
   end subroutine spread_slip

   !> The nodes whose slip others depend on, shape (nodes).
   pure function beside_front(constraints) result(beside)
      type(constraints_type), intent(in) :: constraints
      logical :: beside(size(constraints%status))
      integer :: i

      beside = .false.
      if (.not. allocated(constraints%front)) return
      do i = 1, size(beside)
         if (constraints%front(i)%node > 0) beside(constraints%front(i)%node) = .true.
      end do
   end function beside_front

   !> Whether a force is prescribed that nothing balances: without contact, or a moment on one node.
   pure logical function undetermined(self, model, constraints)
      class(reduced_system_type), intent(in) :: self
      type(contact_model_type), intent(in) :: model
      type(constraints_type), intent(in) :: constraints
      integer :: i

      undetermined = any([(i /= motion_shift .and. model%moves(i) .and. self%place(i, a_motion) == 0 .and. &
                           constraints%load(i)%control == control_force, i=1, motion_count)])
   end function undetermined

   !> Reset the system for other blocks or motions; renumber the nodes if the mesh has grown. (An object serves one model.)
   subroutine match(self, model)
      class(reduced_system_type), intent(inout) :: self
      type(contact_model_type), intent(in) :: model
      integer, allocatable :: place(:, :), constraint_of(:, :)
      logical :: same
      integer :: extra, i, n, room

      n = model%nodes()
      room = max(n, motion_count)
      if (self%nodes > 0) then
         same = all(self%block .eqv. model%compliance%has_block) .and. all(self%moves .eqv. model%moves)
         if (same .and. self%nodes == n) return
         if (same .and. n > self%nodes) then
            extra = (n - self%nodes)/2
            allocate (place(room, a_motion), constraint_of(room, a_motion), source=0)
            place(extra + 1:n - extra, :a_shear) = self%place(:self%nodes, :a_shear)
            constraint_of(extra + 1:n - extra, a_shear) = self%constraint_of(:self%nodes, a_shear)
            place(:motion_count, a_motion) = self%place(:motion_count, a_motion)
            constraint_of(:motion_count, a_motion) = self%constraint_of(:motion_count, a_motion)
            call move_alloc(place, self%place)
            call move_alloc(constraint_of, self%constraint_of)
            self%nodes = n
            do i = 1, 2
               associate (subsystem => self%subsystem(i))
                  associate (sort => subsystem%sort(:subsystem%unknowns), of => subsystem%of(:subsystem%unknowns))
                     where (sort /= a_motion) of = of + extra
                  end associate
               end associate
            end do
            return
         end if
      end if
      self%block = model%compliance%has_block
      self%moves = model%moves
      self%length = model%length()
      self%arm = arm_unit([(i, i=1, motion_count)], self%length, model%compliance%modulus)
      self%apart = .not. (self%block(block_wt) .or. model%motions_couple())
      self%nodes = n
      if (allocated(self%place)) deallocate (self%place, self%constraint_of)
      allocate (self%place(room, a_motion), self%constraint_of(room, a_motion), source=0)
      do i = 1, 2
         call self%subsystem(i)%system%clear()
         self%subsystem(i)%unknowns = 0
         if (.not. allocated(self%subsystem(i)%sort)) &
            allocate (self%subsystem(i)%sort(0), self%subsystem(i)%of(0), self%subsystem(i)%right(0), &
                      self%subsystem(i)%solution(0), self%subsystem(i)%values(0))
      end do
   end subroutine match

   !> The subsystem of an unknown.
   pure integer function subsystem_of(self, sort, number)
      class(reduced_system_type), intent(in) :: self
      integer, intent(in) :: sort, number

      subsystem_of = 1
      if (.not. self%apart) return
      if (sort == a_shear .or. (sort == a_motion .and. number == motion_shift)) subsystem_of = 2
   end function subsystem_of

   !> Update unknowns and constraints to the statuses and controls of `constraints`. `recompute`: whether to recompute the inverse.
   subroutine follow(self, model, constraints, recompute, singular)
      class(reduced_system_type), intent(inout) :: self
      type(contact_model_type), intent(in) :: model
      type(constraints_type), intent(in) :: constraints
      logical, intent(in) :: recompute
      logical, intent(out) :: singular
      logical :: wanted(size(self%place, 1), a_motion)
      integer :: i

      wanted = .false.
      wanted(:self%nodes, a_pressure) = in_contact(constraints%status)
      wanted(:self%nodes, a_shear) = in_contact(constraints%status) .and. constraints%status /= node_frictionless
      wanted(:self%nodes, a_shear) = wanted(:self%nodes, a_shear) .or. beside_front(constraints)
      wanted(motion_approach, a_motion) = any(wanted(:, a_pressure))
      wanted(motion_shift, a_motion) = any(wanted(:, a_shear))
      ! A motion that only slides (a rotation with radial normals) is determined by friction alone. Bulk stresses are known.
      do i = 1, motion_count
         if (motions(i)%optional .and. model%moves(i) .and. .not. motions(i)%is_known) &
            wanted(i, a_motion) = count(wanted(:, a_pressure)) > 1 .and. (wanted(motion_shift, a_motion) .or. model%lifts(i))
      end do
      call remove_constraints(self, constraints, wanted)
      if (recompute) then
         call rebuild(self, model, wanted, singular)
      else
         call change_unknowns(self, model, wanted, singular)
      end if
      if (.not. singular) call set_constraints(self, model, constraints)
   end subroutine follow

   !> Remove constraints that no longer apply.
   subroutine remove_constraints(self, constraints, wanted)
      class(reduced_system_type), intent(inout) :: self
      type(constraints_type), intent(in) :: constraints
      logical, intent(in) :: wanted(:, :)
      logical :: going(self%nodes)
      integer :: i, subsystem

      subsystem = subsystem_of(self, a_shear, 0)
      going = self%constraint_of(:self%nodes, a_shear) > 0
      where (going) going = .not. wanted(:self%nodes, a_shear) .or. constraints%status == node_stick .or. &
                            (wanted(:self%nodes, a_pressure) .neqv. self%place(:self%nodes, a_pressure) > 0)
      if (2*count(going) > self%subsystem(subsystem)%system%constraints) call self%subsystem(subsystem)%system%postpone()
      do i = 1, self%nodes
         if (going(i)) call release(self, subsystem, self%constraint_of(i, a_shear))
      end do
      do i = 1, motion_count
         if (self%constraint_of(i, a_motion) == 0) cycle
         if (constraints%load(i)%control /= control_force .and. wanted(i, a_motion)) cycle
         call release(self, subsystem_of(self, a_motion, i), self%constraint_of(i, a_motion))
      end do
   end subroutine remove_constraints

   !> Add and remove unknowns one by one, or recompute all if that is less work.
   subroutine change_unknowns(self, model, wanted, singular)
      class(reduced_system_type), intent(inout) :: self
      type(contact_model_type), intent(in) :: model
      logical, intent(in) :: wanted(:, :)
      logical, intent(out) :: singular
      integer, parameter :: few = 16
      integer :: changes(2), i, sort, subsystem

      singular = .false.
      if (all(wanted .eqv. self%place > 0)) return
      changes = 0
      do sort = a_pressure, a_shear
         subsystem = subsystem_of(self, sort, 0)
         changes(subsystem) = changes(subsystem) + count(wanted(:, sort) .neqv. self%place(:, sort) > 0)
      end do
      if (all(changes <= max(few, self%subsystem%unknowns/2))) then
         call remove_unknowns(self, a_motion, wanted, singular)
         ! Add first: with little contact in between the matrix would be singular.
         do subsystem = 1, 2
            if (.not. singular) call add_unknowns(self, model, subsystem, wanted, singular)
         end do
         do i = 1, motion_count
            if (.not. wanted(i, a_motion) .or. self%place(i, a_motion) > 0 .or. singular) cycle
            call add_named(self, model, subsystem_of(self, a_motion, i), [a_motion], [i], singular)
         end do
         call remove_unknowns(self, a_shear, wanted, singular)
         call remove_unknowns(self, a_pressure, wanted, singular)
         if (.not. singular) return
      end if
      call rebuild(self, model, wanted, singular)
   end subroutine change_unknowns

   !> Remove the unknowns of a type that are no longer wanted, unless already `singular`.
   subroutine remove_unknowns(self, sort, wanted, singular)
      class(reduced_system_type), intent(inout) :: self
      integer, intent(in) :: sort
      logical, intent(in) :: wanted(:, :)
      logical, intent(inout) :: singular
      integer :: i

      do i = 1, size(wanted, 1)
         if (singular) return
         if (self%place(i, sort) > 0 .and. .not. wanted(i, sort)) call remove_unknown(self, sort, i, singular)
      end do
   end subroutine remove_unknowns

   !> Add the missing unknowns of nodes of a subsystem.
   subroutine add_unknowns(self, model, p, wanted, singular)
      class(reduced_system_type), intent(inout) :: self
      type(contact_model_type), intent(in) :: model
      integer, intent(in) :: p
      logical, intent(in) :: wanted(:, :)
      logical, intent(out) :: singular
      integer :: new_sort(2*size(wanted, 1)), new_of(2*size(wanted, 1)), i, number, sort

      singular = .false.
      number = 0
      do sort = a_pressure, a_shear
         if (subsystem_of(self, sort, 0) /= p) cycle
         do i = 1, size(wanted, 1)
            if (self%place(i, sort) > 0 .or. .not. wanted(i, sort)) cycle
            number = number + 1
            new_sort(number) = sort
            new_of(number) = i
         end do
      end do
      if (number > 0) call add_named(self, model, p, new_sort(:number), new_of(:number), singular)
   end subroutine add_unknowns

   !> Add unknowns to a subsystem: their types and nodes or motions.
   subroutine add_named(self, model, p, new_sort, new_of, singular)
      class(reduced_system_type), intent(inout) :: self
      type(contact_model_type), intent(in) :: model
      integer, intent(in) :: p, new_sort(:), new_of(:)
      logical, intent(out) :: singular
      real(wp), allocatable :: borders(:, :)
      integer :: i

      do i = 1, size(new_sort)
         call enlist(self, new_sort(i), new_of(i))
      end do
      allocate (borders(self%subsystem(p)%unknowns, size(new_sort)))
      do i = 1, size(new_sort)
         call entries_of(model, self%length, self%arm, self%subsystem(p), new_sort(i), new_of(i), borders(:, i))
      end do
      call self%subsystem(p)%system%add_unknowns(borders, singular)
   end subroutine add_named

   !> Append an unknown to the list of its subsystem.
   subroutine enlist(self, sort, number)
      class(reduced_system_type), intent(inout) :: self
      integer, intent(in) :: sort, number
      integer, parameter :: some = 32
      integer :: i, room

      associate (subsystem => self%subsystem(subsystem_of(self, sort, number)))
         subsystem%unknowns = subsystem%unknowns + 1
         if (subsystem%unknowns > size(subsystem%sort)) then
            room = subsystem%unknowns/2 + some
            subsystem%sort = [subsystem%sort, (0, i=1, room)]
            subsystem%of = [subsystem%of, (0, i=1, room)]
            deallocate (subsystem%right, subsystem%solution)
            allocate (subsystem%right(size(subsystem%sort)), subsystem%solution(size(subsystem%sort)))
         end if
         subsystem%sort(subsystem%unknowns) = sort
         subsystem%of(subsystem%unknowns) = number
         self%place(number, sort) = subsystem%unknowns
      end associate
   end subroutine enlist

   !> Remove an unknown; the last one of the subsystem takes its place.
   subroutine remove_unknown(self, sort, number, singular)
      class(reduced_system_type), intent(inout) :: self
      integer, intent(in) :: sort, number
      logical, intent(out) :: singular
      integer :: here, last

      here = self%place(number, sort)
      associate (subsystem => self%subsystem(subsystem_of(self, sort, number)))
         call subsystem%system%remove_unknown(here, singular)
         if (singular) return
         last = subsystem%unknowns
         subsystem%sort(here) = subsystem%sort(last)
         subsystem%of(here) = subsystem%of(last)
         self%place(subsystem%of(here), subsystem%sort(here)) = here
         subsystem%unknowns = last - 1
      end associate
      self%place(number, sort) = 0
   end subroutine remove_unknown

   !> Recompute the inverses for all unknowns, without constraints.
   subroutine rebuild(self, model, wanted, singular)
      class(reduced_system_type), intent(inout) :: self
      type(contact_model_type), intent(in) :: model
      logical, intent(in) :: wanted(:, :)
      logical, intent(out) :: singular
      real(wp), allocatable :: matrix(:, :)
      integer :: i, j, p, sort

      self%constraint_of = 0
      self%place = 0
      do p = 1, 2
         call self%subsystem(p)%system%release_all()
         self%subsystem(p)%unknowns = 0
      end do
      do sort = a_pressure, a_motion
         do i = 1, size(wanted, 1)
            if (wanted(i, sort)) call enlist(self, sort, i)
         end do
      end do
      do p = 1, 2
         associate (subsystem => self%subsystem(p))
            allocate (matrix(subsystem%unknowns, subsystem%unknowns))
            do j = 1, subsystem%unknowns
               call entries_of(model, self%length, self%arm, subsystem, subsystem%sort(j), subsystem%of(j), matrix(:, j))
            end do
            call subsystem%system%refresh(matrix, singular)
            deallocate (matrix)
         end associate
         if (.not. singular) cycle
         ! Invalid: the next solve starts over.
         self%nodes = 0
         return
      end do
   end subroutine rebuild

   !> Entries of the rows of a subsystem in the column of one unknown, in units of the modulus of the compliance and the length of
   !> the mesh; shape (unknowns). `arm`: units of the arms of the motions.
   subroutine entries_of(model, length, arm, subsystem, column_sort, column_of, entries)
      type(contact_model_type), intent(in) :: model
      real(wp), intent(in) :: length, arm(motion_count)
      type(subsystem_type), intent(in) :: subsystem
      integer, intent(in) :: column_sort, column_of
      real(wp), intent(out) :: entries(:)
      !> Displacement of the type of the row by a traction of the type of the column.
      integer, parameter :: block(2, 2) = reshape([block_wp, block_up, block_wt, block_ut], [2, 2])
      real(wp) :: unit, block_entries(size(entries), 1)
      integer :: at(size(entries)), number, i, row_sort

      entries = 0.0_wp
      associate (n => size(entries), sort => subsystem%sort, of => subsystem%of)
         if (column_sort == a_motion) then
            do i = 1, n
               if (sort(i) == a_pressure) entries(i) = -model%normal_arm(of(i), column_of)/arm(column_of)
               if (sort(i) == a_shear) entries(i) = -model%tangential_arm(of(i), column_of)/arm(column_of)
            end do
            return
         end if
         unit = model%compliance%modulus/length*model%interval()/model%width(column_of)
         do row_sort = a_pressure, a_shear
            number = 0
            do i = 1, n
               if (sort(i) /= row_sort) cycle
               number = number + 1
               at(number) = i
            end do
            if (number == 0 .or. .not. model%compliance%has_block(block(row_sort, column_sort))) cycle
            call model%compliance%entries(block(row_sort, column_sort), of(at(:number)), [column_of], block_entries(:number, :))
            entries(at(:number)) = unit*block_entries(:number, 1)
         end do
         do i = 1, n
            if (sort(i) /= a_motion) cycle
            if (column_sort == a_pressure) entries(i) = -model%normal_arm(column_of, of(i))/arm(of(i))
            if (column_sort == a_shear) entries(i) = -model%tangential_arm(column_of, of(i))/arm(of(i))
         end do
      end associate
   end subroutine entries_of

   !> Set the constraints of slipping and creeping nodes and of motions under displacement control.
   subroutine set_constraints(self, model, constraints)
      class(reduced_system_type), intent(inout) :: self
      type(contact_model_type), intent(in) :: model
      type(constraints_type), intent(in) :: constraints
      real(wp) :: stiffness
      integer :: i, partner

      associate (system => self%subsystem(subsystem_of(self, a_shear, 0))%system)
         do i = 1, self%nodes
            if (self%place(i, a_shear) == 0 .or. constraints%status(i) == node_stick) cycle
            partner = 0
            if (.not. self%apart) partner = self%place(i, a_pressure)
            stiffness = constraints%row(i)%stiffness*self%length/model%compliance%modulus*model%width(i)/model%interval()
            associate (c => self%constraint_of(i, a_shear), slope => constraints%row(i)%slope)
               if (c == 0) then
                  call system%add_constraint(self%place(i, a_shear), partner, slope, stiffness)
                  c = system%constraints
                  ! Uncoupled, the slope multiplies the known pressure.
               else if ((partner > 0 .and. abs(system%constraint(c)%slope - slope) > 0.0_wp) .or. &
                        abs(system%constraint(c)%stiffness - stiffness) > 0.0_wp) then
                  call system%change_constraint(c, slope, stiffness)
               end if
            end associate
         end do
      end associate
      do i = 1, motion_count
         if (self%place(i, a_motion) == 0 .or. self%constraint_of(i, a_motion) > 0) cycle
         if (constraints%load(i)%control == control_force) cycle
         associate (system => self%subsystem(subsystem_of(self, a_motion, i))%system)
            call system%add_constraint(self%place(i, a_motion), 0, 0.0_wp, 0.0_wp)
            self%constraint_of(i, a_motion) = system%constraints
         end associate
      end do
   end subroutine set_constraints

   !> Remove a constraint of subsystem `p`; the last one takes its place.
   subroutine release(self, p, number)
      class(reduced_system_type), intent(inout) :: self
      integer, intent(in) :: p, number
      integer :: gone, slot

      gone = number
      associate (subsystem => self%subsystem(p))
         slot = subsystem%system%constraint(subsystem%system%constraints)%slot
         self%constraint_of(subsystem%of(slot), subsystem%sort(slot)) = gone
         slot = subsystem%system%constraint(gone)%slot
         self%constraint_of(subsystem%of(slot), subsystem%sort(slot)) = 0
         call subsystem%system%release(gone)
      end associate
   end subroutine release

   !> Correct the fields, which contain a first guess, until they satisfy the constraints, or (`rates`) their rates. `singular`:
   !> not possible.
   subroutine refine(self, model, constraints, rates, fields, singular)
      class(reduced_system_type), intent(inout) :: self
      type(contact_model_type), intent(in) :: model
      type(constraints_type), intent(in) :: constraints
      logical, intent(in) :: rates
      type(contact_fields_type), intent(inout) :: fields
      logical, intent(out) :: singular
      integer, parameter :: most_passes = 6
      real(wp) :: residual, fine
      integer :: i, pass
      type(scales_type) :: scales, first
      logical :: at_rest

      singular = .false.
      first = scales_type(0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp)
      fine = merge(5.0e-14_wp, 1.0e-14_wp, rates)
      call find_prescribed(constraints, model, rates, self%prescribed)
      call set_known_motions(self, model, fields)
      if (.not. rates) call clear_open_nodes(self, model, fields)
      do pass = 1, most_passes
         ! Rates start from zero: there is no scale yet.
         at_rest = rates .and. pass == 1
         if (.not. at_rest) then
            call find_scales(model, fields, first, scales)
            if (pass == 1) first = scales
         end if
         call find_residual(self, model, constraints, fields, scales, residual)
         if (at_rest) residual = huge(1.0_wp)
         if (residual <= fine) exit
         if (pass > 3 .and. residual <= certified) exit
         if (pass > 1 .or. .not. rates) self%refinements = self%refinements + 1
         call correct(self, model, constraints, scales, fields, singular)
         if (singular) return
      end do
      singular = .not. residual <= certified
      do i = 1, motion_count
         if (.not. model%moves(i)) cycle
         fields%force(i) = model%resultant(i, fields%pressure, fields%shear)
         if (constraints%load(i)%control == control_force .and. self%place(i, a_motion) > 0) &
            fields%force(i) = self%prescribed%load(i)
      end do
   end subroutine refine

   !> Set the motions that are not unknowns, with their effect on the displacements.
   subroutine set_known_motions(self, model, fields)
      class(reduced_system_type), intent(in) :: self
      type(contact_model_type), intent(in) :: model
      type(contact_fields_type), intent(inout) :: fields

      associate (places => self%place(:motion_count, a_motion))
         if (all(places > 0)) return
         if (model%has_rigid_parts()) then
            fields%normal = fields%normal + model%rigid_normal(fields)
            fields%tangential = fields%tangential + model%rigid_tangential(fields)
         end if
         where (places == 0 .and. model%moves) fields%motion = self%prescribed%load
         if (model%has_rigid_parts()) then
            fields%normal = fields%normal - model%rigid_normal(fields)
            fields%tangential = fields%tangential - model%rigid_tangential(fields)
         end if
      end associate
   end subroutine set_known_motions

   !> Set the tractions of nodes without unknowns to zero.
   subroutine clear_open_nodes(self, model, fields)
      class(reduced_system_type), intent(in) :: self
      type(contact_model_type), intent(in) :: model
      type(contact_fields_type), intent(inout) :: fields
      real(wp) :: largest, scale

      scale = max(maxval(abs(fields%pressure)), maxval(abs(fields%shear)))
      associate (has_pressure => self%place(:self%nodes, a_pressure) > 0, has_shear => self%place(:self%nodes, a_shear) > 0)
         largest = max(maxval(abs(fields%pressure), mask=.not. has_pressure), maxval(abs(fields%shear), mask=.not. has_shear))
         where (.not. has_pressure) fields%pressure = 0.0_wp
         where (.not. has_shear) fields%shear = 0.0_wp
      end associate
      if (largest > rounding*scale) call model%displace(fields)
   end subroutine clear_open_nodes

   !> Residuals of all rows and constraints, in their units, as right sides for a correction; and the largest of them, relative to
   !> the magnitude of its type.
   subroutine find_residual(self, model, constraints, fields, scales, largest)
      class(reduced_system_type), intent(inout) :: self
      type(contact_model_type), intent(in) :: model
      type(constraints_type), intent(in) :: constraints
      type(contact_fields_type), intent(in) :: fields
      type(scales_type), intent(in) :: scales
      real(wp), intent(out) :: largest
      real(wp) :: missing, by_length, by_stress, gap_rest, slip_rest, traction_rest, stiffness, slip(self%nodes)
      integer :: i, node, p

      by_length = 1.0_wp/self%length
      by_stress = 1.0_wp/(model%interval()*model%compliance%modulus)
      gap_rest = 0.0_wp
      slip_rest = 0.0_wp
      traction_rest = 0.0_wp
      largest = 0.0_wp
      slip = fields%slip()
      do p = 1, 2
         associate (subsystem => self%subsystem(p), prescribed => self%prescribed)
            if (size(subsystem%values) < subsystem%system%constraints) then
               deallocate (subsystem%values)
               allocate (subsystem%values(2*subsystem%system%constraints))
            end if
            do i = 1, subsystem%unknowns
               node = subsystem%of(i)
               if (subsystem%sort(i) == a_pressure) then
                  missing = fields%motion(motion_approach) - fields%normal(node) + prescribed%opening(node)
                  gap_rest = max(gap_rest, abs(missing))
                  subsystem%right(i) = missing*by_length
               else if (subsystem%sort(i) == a_motion .and. self%constraint_of(node, a_motion) > 0) then
                  missing = (prescribed%load(node) - fields%motion(node))*self%arm(node)
                  largest = max(largest, relative(abs(missing), scales%normal))
                  subsystem%values(self%constraint_of(node, a_motion)) = missing*by_length
                  subsystem%right(i) = 0.0_wp
               else if (subsystem%sort(i) == a_motion) then
                  missing = (model%resultant(node, fields%pressure, fields%shear) - prescribed%load(node))/self%arm(node)
                  largest = max(largest, relative(abs(missing), merge(scales%shear_force, scales%force, node == motion_shift)))
                  subsystem%right(i) = missing*by_stress
               else if (constraints%status(node) == node_stick) then
                  missing = prescribed%slip(node) - slip(node)
                  if (allocated(constraints%front)) then
                     if (constraints%front(node)%node > 0) &
                        missing = missing + constraints%front(node)%weight*slip(constraints%front(node)%node)
                  end if
                  slip_rest = max(slip_rest, abs(missing))
                  subsystem%right(i) = missing*by_length
               else
                  missing = shear_residual(self, constraints, fields, node)
                  stiffness = abs(constraints%row(node)%stiffness)
                  if (stiffness > 0.0_wp) then
                     ! Its slip is as accurate as that of a stuck node.
                     largest = max(largest, abs(missing)/max(scales%traction, stiffness*scales%tangential))
                  else
                     traction_rest = max(traction_rest, abs(missing))
                  end if
                  subsystem%values(self%constraint_of(node, a_shear)) = missing*model%width(node)*by_stress
                  subsystem%right(i) = 0.0_wp
               end if
            end do
         end associate
      end do
      largest = max(largest, gap_rest/scales%normal, slip_rest/scales%tangential, traction_rest/scales%traction)
   end subroutine find_residual

   !> Magnitudes of the fields. Fields that vanish consist of round-off: magnitudes are at least a very small fraction of the
   !> `first` ones, and of those that the displacements imply.
   pure subroutine find_scales(model, fields, first, scales)
      type(contact_model_type), intent(in) :: model
      type(contact_fields_type), intent(in) :: fields
      type(scales_type), intent(in) :: first
      type(scales_type), intent(out) :: scales
      real(wp), parameter :: least = 1.0e-10_wp, smallest = 1.0e-270_wp
      real(wp) :: normal, tangential, traction, force, shear_force, possible
      integer :: i

      normal = max(abs(fields%motion(motion_approach)), least*first%normal, smallest)
      tangential = max(abs(fields%motion(motion_shift)), least*first%tangential, smallest)
      if (model%has_rigid_parts()) then
         normal = max(normal, abs(fields%motion(motion_shift)), abs(fields%motion(motion_rotation))*model%length(), &
                      maxval(abs(model%rigid_normal(fields))))
         tangential = max(tangential, maxval(abs(model%rigid_tangential(fields))))
      end if
      traction = max(least*first%traction, smallest)
      force = smallest
      shear_force = smallest
      do i = 1, size(fields%pressure)
         normal = max(normal, abs(fields%normal(i)))
         tangential = max(tangential, abs(fields%tangential(i)))
         traction = max(traction, abs(fields%pressure(i)), abs(fields%shear(i)))
         force = force + model%width(i)*abs(fields%pressure(i))
         shear_force = shear_force + model%width(i)*abs(fields%shear(i))
      end do
      tangential = max(tangential, model%friction_scale*normal)
      normal = max(normal, tangential)
      possible = least*model%compliance%modulus*normal
      traction = max(traction, possible/model%length())
      force = max(force, least*first%force, possible)
      shear_force = max(shear_force, model%friction_scale*force, least*first%shear_force)
      scales = scales_type(normal, tangential, traction, max(force, shear_force), shear_force)
   end subroutine find_scales

   !> A magnitude relative to its scale, or the largest real if the quotient would overflow (a load on an empty contact).
   pure real(wp) function relative(magnitude, scale)
      real(wp), intent(in) :: magnitude, scale

      relative = huge(1.0_wp)
      if (magnitude < min(scale, 1.0_wp)*huge(1.0_wp)) relative = magnitude/scale
   end function relative

   !> Residual of the shear traction of a slipping or creeping node.
   pure real(wp) function shear_residual(self, constraints, fields, node)
      class(reduced_system_type), intent(in) :: self
      type(constraints_type), intent(in) :: constraints
      type(contact_fields_type), intent(in) :: fields
      integer, intent(in) :: node

      associate (row => constraints%row(node))
         shear_residual = row%slope*fields%pressure(node) - fields%shear(node)
         if (abs(row%stiffness) > 0.0_wp) &
            shear_residual = shear_residual + row%stiffness*(fields%tangential(node) - fields%motion(motion_shift))
         shear_residual = shear_residual + self%prescribed%offset(node)
      end associate
   end function shear_residual

   !> Solve for a correction from the residuals, and apply it.
   subroutine correct(self, model, constraints, scales, fields, singular)
      class(reduced_system_type), intent(inout) :: self
      type(contact_model_type), intent(in) :: model
      type(constraints_type), intent(in) :: constraints
      type(scales_type), intent(in) :: scales
      type(contact_fields_type), intent(inout) :: fields
      logical, intent(out) :: singular
      real(wp) :: residual
      integer :: p

      singular = .false.
      do p = 1, 2
         if (self%subsystem(p)%unknowns == 0) cycle
         if (p == 2) call find_residual(self, model, constraints, fields, scales, residual)
         associate (subsystem => self%subsystem(p), n => self%subsystem(p)%unknowns)
            call subsystem%system%solve(subsystem%right(:n), subsystem%values(:subsystem%system%constraints), &
                                        subsystem%solution(:n), singular)
            ! NaN would pass the residual check.
            if (.not. singular) singular = .not. all(abs(subsystem%solution(:n)) <= huge(1.0_wp))
         end associate
         if (singular) return
         call apply(self, model, constraints, p, fields)
         if (self%apart .and. p == 1 .and. self%subsystem(2)%unknowns > 0 .and. .not. self%block(block_up)) cycle
         call model%displace(fields)
      end do
   end subroutine correct

   !> Add the solution of a subsystem to the fields; shear tractions of slipping nodes follow from their lines.
   subroutine apply(self, model, constraints, p, fields)
      class(reduced_system_type), intent(in) :: self
      type(contact_model_type), intent(in) :: model
      type(constraints_type), intent(in) :: constraints
      integer, intent(in) :: p
      type(contact_fields_type), intent(inout) :: fields
      integer :: i

      associate (subsystem => self%subsystem(p), stress => model%compliance%modulus*model%interval())
         do i = 1, subsystem%unknowns
            associate (node => subsystem%of(i), change => subsystem%solution(i))
               if (subsystem%sort(i) == a_motion) then
                  fields%motion(node) = fields%motion(node) + change*self%length/self%arm(node)
               else if (subsystem%sort(i) == a_pressure) then
                  fields%pressure(node) = fields%pressure(node) + stress/model%width(node)*change
               else
                  fields%shear(node) = fields%shear(node) + stress/model%width(node)*change
               end if
            end associate
         end do
      end associate
      if (p /= subsystem_of(self, a_shear, 0)) return
      do i = 1, self%nodes
         if (self%constraint_of(i, a_shear) == 0 .or. abs(constraints%row(i)%stiffness) > 0.0_wp) cycle
         fields%shear(i) = fields%shear(i) + shear_residual(self, constraints, fields, i)
      end do
   end subroutine apply

end module mfv_reduced_system
