!> The reduced system: unknowns are the pressures of the nodes in contact, the shear tractions of those that friction holds or
!> brakes, and the rigid motions, all others eliminated from dissertation eq. 2.2.
!>
!> With every node in contact taken to be stuck its matrix is
!>
!>     [  C   -N ]
!>     [ -N'   0 ],    C the compliance between these nodes, N what the rigid motions do to gap and slip,
!>
!> symmetric by reciprocity (tractions times the nodes' widths, where these differ). Its inverse is kept, and changed where
!> nodes come into contact or leave it. What slips, creeps or is led by displacements is a constraint with an unknown slip or
!> force (mfv_constrained_inverse); so a node that begins or ceases to slip costs as many operations as a few vectors have
!> entries, and a reversal, where all stick again, nothing. The residuals of all rows are checked after every solve with the
!> full compliance; where they are too large the solution is refined, and where that does not help the inverse is computed anew.
!>
!> Without the effect of shear on the normal problem (Goodman's coupling, none, no friction) the two problems are solved one
!> after the other, each with an inverse of its own. Goodman's coupling with rotation or radial normals is not symmetric: there
!> the augmented system takes over.
module mfv_reduced_system
   use mfv_augmented_system, only: augmented_system_type
   use mfv_compliance, only: block_up, block_ut, block_wp, block_wt
   use mfv_constrained_inverse, only: constrained_inverse_type
   use mfv_contact_fields, only: contact_fields_type
   use mfv_contact_model, only: contact_model_type
   use mfv_contact_system
   use mfv_kinds, only: wp
   use mfv_motions, only: motions, motion_count, motion_approach, motion_shift, motion_rotation, control_force, arm_unit
   use mfv_node_status, only: node_stick
   implicit none
   private
   public :: reduced_system_type

   !> What an unknown is: of a node, or of the upper body.
   integer, parameter :: a_pressure = 1, a_shear = 2, a_motion = 3

   !> A part of the system that is solved on its own.
   type :: part_type
      type(constrained_inverse_type) :: system
      !> Sort of every unknown, and its node or motion; shape (capacity), the first `unknowns` are in use.
      integer :: unknowns = 0
      integer, allocatable :: sort(:), of(:)
      !> Right side and solution of the rows, and values of the constraints.
      real(wp), allocatable :: right(:), solution(:), values(:)
   end type part_type

   !> Magnitudes that what is missing is measured by: normal and tangential displacements, length; tractions, force/length^2;
   !> all forces and tangential ones, force/length.
   type :: scales_type
      real(wp) :: normal = 1.0_wp, tangential = 1.0_wp, traction = 1.0_wp, force = 1.0_wp, shear_force = 1.0_wp
   end type scales_type

   type, extends(contact_system_type) :: reduced_system_type
      private
      !> Normal and tangential problem where they are apart, else both in the first.
      type(part_type) :: part(2)
      logical :: apart = .false.
      !> Where the unknowns of the nodes are in their part, shape (nodes, 2), and those of the motions; 0: nowhere.
      integer, allocatable :: place(:, :)
      integer :: motion_place(motion_count) = 0
      !> Constraint of every node (shape (nodes)) and motion; 0: none.
      integer, allocatable :: constraint_of(:)
      integer :: motion_constraint(motion_count) = 0
      !> Unit of length: half the mesh when the first unknown came; it stays while the mesh grows.
      real(wp) :: length = 1.0_wp
      !> What the inverses were built for.
      logical :: block(4) = .false., moves(motion_count) = .false.
      type(augmented_system_type) :: augmented
      !> How often a solution was refined.
      integer, public :: refinements = 0
   contains
      procedure :: solve
      procedure :: rebuilds
      procedure, private :: match
      procedure, private :: undetermined
      procedure, private :: follow
      procedure, private :: lose_constraints
      procedure, private :: change_unknowns
      procedure, private :: change_motions
      procedure, private :: set_constraints
      procedure, private :: release
      procedure, private :: add_unknowns
      procedure, private :: add_named
      procedure, private :: remove_unknown
      procedure, private :: rebuild
      procedure, private :: part_of
      procedure, private :: refine
      procedure, private :: set_known_motions
      procedure, private :: find_residual
      procedure, private :: correct
   end type reduced_system_type

contains

   !> How often inverses were computed anew.
   pure integer function rebuilds(self)
      class(reduced_system_type), intent(in) :: self

      rebuilds = sum(self%part%system%inverse%rebuilds)
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
      if (model%compliance%one_way() .and. model%has_rigid_parts()) then
         self%name = self%augmented%name
         call self%augmented%solve(model, constraints, start, response, singular)
         return
      end if
      call self%match(model)
      call respond(self, model, constraints, start, .false., response, singular)
      ! The inverse may have lost its digits: once more with a new one.
      if (singular .and. .not. self%undetermined(model, constraints)) &
         call respond(self, model, constraints, start, .true., response, singular)
   end subroutine solve

   !> State and rates. `anew`: with the inverse computed anew.
   subroutine respond(self, model, constraints, start, anew, response, singular)
      class(reduced_system_type), intent(inout) :: self
      type(contact_model_type), intent(in) :: model
      type(constraints_type), intent(in) :: constraints
      type(contact_fields_type), intent(in) :: start
      logical, intent(in) :: anew
      type(response_type), intent(inout) :: response
      logical, intent(out) :: singular

      if (anew) call self%match(model)
      call self%follow(model, constraints, anew, singular)
      if (.not. singular) singular = self%undetermined(model, constraints)
      if (singular) return
      call response%state%take(start)
      call self%refine(model, constraints, .false., response%state, singular)
      if (singular) return
      call response%rate%clear(size(constraints%status))
      call self%refine(model, constraints, .true., response%rate, singular)
   end subroutine respond

   !> Whether a force is prescribed where nothing answers to it: without contact, or a moment on one node.
   pure logical function undetermined(self, model, constraints)
      class(reduced_system_type), intent(in) :: self
      type(contact_model_type), intent(in) :: model
      type(constraints_type), intent(in) :: constraints
      integer :: i

      undetermined = .false.
      do i = 1, motion_count
         if (i == motion_shift .or. .not. model%moves(i)) cycle
         undetermined = undetermined .or. (self%motion_place(i) == 0 .and. .not. is_held(constraints, i))
      end do
   end function undetermined

   !> Forget what belongs to other blocks, or to a scene without rotation; follow the nodes where the mesh has grown. (An object
   !> serves one model.)
   subroutine match(self, model)
      class(reduced_system_type), intent(inout) :: self
      type(contact_model_type), intent(in) :: model
      integer, allocatable :: place(:, :), constraint_of(:)
      logical :: same
      integer :: extra, i, n

      n = model%nodes()
      if (allocated(self%place)) then
         same = all(self%block .eqv. model%compliance%has_block) .and. all(self%moves .eqv. model%moves)
         if (same .and. size(self%place, 1) == n) return
         if (same .and. n > size(self%place, 1)) then
            extra = (n - size(self%place, 1))/2
            allocate (place(n, 2), constraint_of(n), source=0)
            place(extra + 1:n - extra, :) = self%place
            constraint_of(extra + 1:n - extra) = self%constraint_of
            call move_alloc(place, self%place)
            call move_alloc(constraint_of, self%constraint_of)
            do i = 1, 2
               associate (part => self%part(i))
                  where (part%sort(:part%unknowns) /= a_motion) part%of(:part%unknowns) = part%of(:part%unknowns) + extra
               end associate
            end do
            return
         end if
         deallocate (self%place, self%constraint_of)
      end if
      self%block = model%compliance%has_block
      self%moves = model%moves
      self%length = model%length()
      self%apart = .not. (self%block(block_wt) .or. model%has_rigid_parts())
      self%motion_place = 0
      self%motion_constraint = 0
      allocate (self%place(n, 2), self%constraint_of(n), source=0)
      do i = 1, 2
         call self%part(i)%system%clear()
         self%part(i)%unknowns = 0
         if (.not. allocated(self%part(i)%sort)) &
            allocate (self%part(i)%sort(0), self%part(i)%of(0), self%part(i)%right(0), self%part(i)%solution(0), &
                      self%part(i)%values(0))
      end do
   end subroutine match

   !> The part that an unknown of some sort belongs to.
   pure integer function part_of(self, sort, number)
      class(reduced_system_type), intent(in) :: self
      integer, intent(in) :: sort, number

      part_of = 1
      if (.not. self%apart) return
      if (sort == a_shear .or. (sort == a_motion .and. number == motion_shift)) part_of = 2
   end function part_of

   !> Bring unknowns and constraints to the statuses and controls of `constraints`. `anew`: compute the inverse anew.
   subroutine follow(self, model, constraints, anew, singular)
      class(reduced_system_type), intent(inout) :: self
      type(contact_model_type), intent(in) :: model
      type(constraints_type), intent(in) :: constraints
      logical, intent(in) :: anew
      logical, intent(out) :: singular
      logical, parameter :: touches(0:6) = [.false., .true., .true., .true., .true., .true., .true.], &
                            has_shear(0:6) = [.false., .true., .true., .true., .false., .true., .true.]
      logical :: wanted(size(constraints%status), 2), wanted_motion(motion_count)
      integer :: i

      wanted(:, a_pressure) = touches(constraints%status)
      wanted(:, a_shear) = has_shear(constraints%status)
      wanted_motion = .false.
      wanted_motion(motion_approach) = any(wanted(:, a_pressure))
      wanted_motion(motion_shift) = any(wanted(:, a_shear))
      ! What only slides, a rotation where normals are along the radius, nothing but friction determines.
      do i = 1, motion_count
         if (motions(i)%optional .and. model%moves(i)) &
            wanted_motion(i) = count(wanted(:, a_pressure)) > 1 .and. (wanted_motion(motion_shift) .or. model%lifts(i))
      end do
      call self%lose_constraints(constraints, wanted, wanted_motion)
      if (anew) then
         call self%rebuild(model, wanted, wanted_motion, singular)
      else
         call self%change_unknowns(model, wanted, wanted_motion, singular)
      end if
      if (singular) return
      call self%set_constraints(model, constraints)
   end subroutine follow

   !> Release what is no longer constrained, or no longer there.
   subroutine lose_constraints(self, constraints, wanted, wanted_motion)
      class(reduced_system_type), intent(inout) :: self
      type(constraints_type), intent(in) :: constraints
      logical, intent(in) :: wanted(:, :), wanted_motion(motion_count)
      integer :: going(size(wanted, 1)), i, number, part

      part = self%part_of(a_shear, 0)
      number = 0
      do i = 1, size(wanted, 1)
         if (self%constraint_of(i) == 0) cycle
         if (wanted(i, a_shear) .and. constraints%status(i) /= node_stick) cycle
         number = number + 1
         going(number) = i
      end do
      if (2*number > self%part(part)%system%constraints) call self%part(part)%system%postpone()
      do i = 1, number
         call self%release(part, self%constraint_of(going(i)))
      end do
      do i = 1, motion_count
         if (self%motion_constraint(i) == 0) cycle
         if (is_held(constraints, i) .and. wanted_motion(i)) cycle
         call self%release(self%part_of(a_motion, i), self%motion_constraint(i))
      end do
   end subroutine lose_constraints

   !> Whether a rigid motion is prescribed, and not its force.
   pure logical function is_held(constraints, motion)
      type(constraints_type), intent(in) :: constraints
      integer, intent(in) :: motion

      is_held = constraints%load(motion)%control /= control_force
   end function is_held

   !> Add and remove unknowns one by one, or all of them anew where that is less work.
   subroutine change_unknowns(self, model, wanted, wanted_motion, singular)
      class(reduced_system_type), intent(inout) :: self
      type(contact_model_type), intent(in) :: model
      logical, intent(in) :: wanted(:, :), wanted_motion(motion_count)
      logical, intent(out) :: singular
      integer, parameter :: few = 16
      integer :: changes(2), i, sort, part

      changes = 0
      do sort = a_pressure, a_shear
         part = self%part_of(sort, 0)
         do i = 1, size(wanted, 1)
            if (wanted(i, sort) .neqv. self%place(i, sort) > 0) changes(part) = changes(part) + 1
         end do
      end do
      singular = .false.
      if (all(changes == 0) .and. all(wanted_motion .eqv. self%motion_place > 0)) return
      if (all(changes <= max(few, self%part%unknowns/2))) then
         ! What is added comes first: with little contact left in between the matrix would have no inverse.
         call self%change_motions(model, wanted_motion, .false., singular)
         do part = 1, 2
            if (.not. singular) call self%add_unknowns(model, part, wanted, singular)
         end do
         if (.not. singular) call self%change_motions(model, wanted_motion, .true., singular)
         do sort = a_shear, a_pressure, -1
            do i = 1, size(wanted, 1)
               if (singular) exit
               if (self%place(i, sort) > 0 .and. .not. wanted(i, sort)) call self%remove_unknown(sort, i, singular)
            end do
         end do
         if (.not. singular) return
      end if
      call self%rebuild(model, wanted, wanted_motion, singular)
   end subroutine change_unknowns

   !> Motions that are no longer unknown, or (`adding`) that now are.
   subroutine change_motions(self, model, wanted_motion, adding, singular)
      class(reduced_system_type), intent(inout) :: self
      type(contact_model_type), intent(in) :: model
      logical, intent(in) :: wanted_motion(motion_count), adding
      logical, intent(inout) :: singular
      integer :: i

      do i = 1, motion_count
         if (singular) return
         if (adding .and. wanted_motion(i) .and. self%motion_place(i) == 0) then
            call self%add_named(model, self%part_of(a_motion, i), [a_motion], [i], singular)
         else if (.not. adding .and. self%motion_place(i) > 0 .and. .not. wanted_motion(i)) then
            call self%remove_unknown(a_motion, i, singular)
         end if
      end do
   end subroutine change_motions

   !> The unknowns of nodes that a part lacks.
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
         if (self%part_of(sort, 0) /= p) cycle
         do i = 1, size(wanted, 1)
            if (self%place(i, sort) > 0 .or. .not. wanted(i, sort)) cycle
            number = number + 1
            new_sort(number) = sort
            new_of(number) = i
         end do
      end do
      if (number > 0) call self%add_named(model, p, new_sort(:number), new_of(:number), singular)
   end subroutine add_unknowns

   !> More unknowns of a part: their sorts and nodes or motions.
   subroutine add_named(self, model, p, new_sort, new_of, singular)
      class(reduced_system_type), intent(inout) :: self
      type(contact_model_type), intent(in) :: model
      integer, intent(in) :: p, new_sort(:), new_of(:)
      logical, intent(out) :: singular
      real(wp), allocatable :: borders(:, :)
      integer :: i, n

      do i = 1, size(new_sort)
         call enlist(self%part(p), new_sort(i), new_of(i))
         if (new_sort(i) == a_motion) then
            self%motion_place(new_of(i)) = self%part(p)%unknowns
         else
            self%place(new_of(i), new_sort(i)) = self%part(p)%unknowns
         end if
      end do
      n = self%part(p)%unknowns
      allocate (borders(n, size(new_sort)))
      do i = 1, size(new_sort)
         call entries_of(model, self%length, self%part(p)%sort(:n), self%part(p)%of(:n), new_sort(i), new_of(i), borders(:, i))
      end do
      call self%part(p)%system%add_unknowns(borders, singular)
   end subroutine add_named

   !> One more name in the list of a part's unknowns.
   subroutine enlist(part, sort, number)
      type(part_type), intent(inout) :: part
      integer, intent(in) :: sort, number
      integer, parameter :: some = 32
      integer :: i, room

      part%unknowns = part%unknowns + 1
      if (part%unknowns > size(part%sort)) then
         room = part%unknowns/2 + some
         part%sort = [part%sort, (0, i=1, room)]
         part%of = [part%of, (0, i=1, room)]
         deallocate (part%right, part%solution)
         allocate (part%right(size(part%sort)), part%solution(size(part%sort)))
      end if
      part%sort(part%unknowns) = sort
      part%of(part%unknowns) = number
   end subroutine enlist

   !> One unknown less; the last of the part takes its place.
   subroutine remove_unknown(self, sort, number, singular)
      class(reduced_system_type), intent(inout) :: self
      integer, intent(in) :: sort, number
      logical, intent(out) :: singular
      integer :: here, last, p

      p = self%part_of(sort, number)
      if (sort == a_motion) then
         here = self%motion_place(number)
      else
         here = self%place(number, sort)
      end if
      call self%part(p)%system%remove_unknown(here, singular)
      if (singular) return
      associate (part => self%part(p))
         last = part%unknowns
         part%sort(here) = part%sort(last)
         part%of(here) = part%of(last)
         if (part%sort(here) == a_motion) then
            self%motion_place(part%of(here)) = here
         else
            self%place(part%of(here), part%sort(here)) = here
         end if
         part%unknowns = last - 1
      end associate
      if (sort == a_motion) then
         self%motion_place(number) = 0
      else
         self%place(number, sort) = 0
      end if
   end subroutine remove_unknown

   !> All unknowns anew. Constraints stay with theirs; those whose unknown has another place follow it.
   subroutine rebuild(self, model, wanted, wanted_motion, singular)
      class(reduced_system_type), intent(inout) :: self
      type(contact_model_type), intent(in) :: model
      logical, intent(in) :: wanted(:, :), wanted_motion(motion_count)
      logical, intent(out) :: singular
      real(wp), allocatable :: matrix(:, :)
      integer :: i, j, p, sort

      self%constraint_of = 0
      self%motion_constraint = 0
      self%place = 0
      self%motion_place = 0
      do p = 1, 2
         call self%part(p)%system%release_all()
         self%part(p)%unknowns = 0
      end do
      do sort = a_pressure, a_shear
         do i = 1, size(wanted, 1)
            if (.not. wanted(i, sort)) cycle
            p = self%part_of(sort, i)
            call enlist(self%part(p), sort, i)
            self%place(i, sort) = self%part(p)%unknowns
         end do
      end do
      do i = 1, motion_count
         if (.not. wanted_motion(i)) cycle
         p = self%part_of(a_motion, i)
         call enlist(self%part(p), a_motion, i)
         self%motion_place(i) = self%part(p)%unknowns
      end do
      do p = 1, 2
         associate (n => self%part(p)%unknowns)
            allocate (matrix(n, n))
            do j = 1, n
               call entries_of(model, self%length, self%part(p)%sort(:n), self%part(p)%of(:n), self%part(p)%sort(j), &
                               self%part(p)%of(j), matrix(:, j))
            end do
            call self%part(p)%system%refresh(matrix, singular)
            deallocate (matrix)
         end associate
         if (.not. singular) cycle
         ! Nothing is left of it: the next solve begins again.
         deallocate (self%place, self%constraint_of)
         return
      end do
   end subroutine rebuild

   !> Entries of the rows `sort`, `of` in the column of one unknown, in units of the compliance's modulus and the mesh's length.
   subroutine entries_of(model, length, sort, of, column_sort, column_of, entries)
      type(contact_model_type), intent(in) :: model
      real(wp), intent(in) :: length
      integer, intent(in) :: sort(:), of(:), column_sort, column_of
      real(wp), intent(out) :: entries(:)
      real(wp) :: unit, block_entries(size(sort), 1)
      integer :: rows(size(sort)), at(size(sort)), block, i, n, row_sort

      entries = 0.0_wp
      if (column_sort == a_motion) then
         do i = 1, size(sort)
            if (sort(i) == a_pressure) entries(i) = -model%normal_arm(of(i), column_of)/arm_unit(column_of, length)
            if (sort(i) == a_shear) entries(i) = -model%tangential_arm(of(i), column_of)/arm_unit(column_of, length)
         end do
         return
      end if
      unit = model%compliance%modulus/length*model%interval()/model%width(column_of)
      do row_sort = a_pressure, a_shear
         n = 0
         do i = 1, size(sort)
            if (sort(i) /= row_sort) cycle
            n = n + 1
            rows(n) = of(i)
            at(n) = i
         end do
         block = block_between(row_sort, column_sort)
         if (n == 0 .or. .not. model%compliance%has_block(block)) cycle
         call model%compliance%entries(block, rows(:n), [column_of], block_entries(:n, :))
         entries(at(:n)) = unit*block_entries(:n, 1)
      end do
      do i = 1, size(sort)
         if (sort(i) /= a_motion) cycle
         if (column_sort == a_pressure) entries(i) = -model%normal_arm(column_of, of(i))/arm_unit(of(i), length)
         if (column_sort == a_shear) entries(i) = -model%tangential_arm(column_of, of(i))/arm_unit(of(i), length)
      end do
   end subroutine entries_of

   !> Displacement of the rows' sort by a traction of the column's.
   pure integer function block_between(row_sort, column_sort)
      integer, intent(in) :: row_sort, column_sort

      if (row_sort == a_pressure) then
         block_between = merge(block_wp, block_wt, column_sort == a_pressure)
      else
         block_between = merge(block_up, block_ut, column_sort == a_pressure)
      end if
   end function block_between

   !> Constraints of the nodes that slip or creep, and of the motions that are held.
   subroutine set_constraints(self, model, constraints)
      class(reduced_system_type), intent(inout) :: self
      type(contact_model_type), intent(in) :: model
      type(constraints_type), intent(in) :: constraints
      real(wp) :: stiffness
      integer :: i, p, partner

      p = self%part_of(a_shear, 0)
      do i = 1, size(constraints%status)
         if (self%place(i, a_shear) == 0 .or. constraints%status(i) == node_stick) cycle
         partner = 0
         if (.not. self%apart) partner = self%place(i, a_pressure)
         stiffness = constraints%row(i)%stiffness*self%length/model%compliance%modulus*model%width(i)/model%interval()
         if (self%constraint_of(i) == 0) then
            call self%part(p)%system%constrain(self%place(i, a_shear), partner, constraints%row(i)%slope, stiffness)
            self%constraint_of(i) = self%part(p)%system%constraints
         else
            associate (system => self%part(p)%system, c => self%constraint_of(i))
               ! Apart, the slope comes in with the known pressure.
               if ((partner > 0 .and. abs(system%slope(c) - constraints%row(i)%slope) > 0.0_wp) .or. &
                   abs(system%stiffness(c) - stiffness) > 0.0_wp) &
                  call system%change_constraint(c, constraints%row(i)%slope, stiffness)
            end associate
         end if
      end do
      do i = 1, motion_count
         if (self%motion_place(i) == 0 .or. self%motion_constraint(i) > 0 .or. .not. is_held(constraints, i)) cycle
         p = self%part_of(a_motion, i)
         call self%part(p)%system%constrain(self%motion_place(i), 0, 0.0_wp, 0.0_wp)
         self%motion_constraint(i) = self%part(p)%system%constraints
      end do
   end subroutine set_constraints

   !> Lose a constraint of part `p`; the last one takes its place.
   subroutine release(self, p, number)
      class(reduced_system_type), intent(inout) :: self
      integer, intent(in) :: p, number
      integer :: gone, last

      associate (part => self%part(p))
         last = part%system%constraints
         gone = number
         call name_constraint(part%system%slot(gone), 0)
         if (last /= gone) call name_constraint(part%system%slot(last), gone)
         call part%system%release(gone)
      end associate

   contains

      !> Note that the constraint of an unknown has a number.
      subroutine name_constraint(slot, new_number)
         integer, intent(in) :: slot, new_number

         if (self%part(p)%sort(slot) == a_motion) then
            self%motion_constraint(self%part(p)%of(slot)) = new_number
         else
            self%constraint_of(self%part(p)%of(slot)) = new_number
         end if
      end subroutine name_constraint
   end subroutine release

   !> Correct the fields until they satisfy the constraints, or (`rates`) their rates; they come with a guess. `singular`: that
   !> cannot be done.
   subroutine refine(self, model, constraints, rates, fields, singular)
      class(reduced_system_type), intent(inout) :: self
      type(contact_model_type), intent(in) :: model
      type(constraints_type), intent(in) :: constraints
      logical, intent(in) :: rates
      type(contact_fields_type), intent(inout) :: fields
      logical, intent(out) :: singular
      integer, parameter :: most_passes = 6
      real(wp), parameter :: fair = 1.0e-10_wp
      real(wp) :: residual, fine
      integer :: i, pass
      type(load_type) :: load
      type(scales_type) :: scales, first
      real(wp) :: value
      logical :: at_rest

      singular = .false.
      first = scales_type(0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp)
      fine = merge(5.0e-14_wp, 1.0e-14_wp, rates)
      call self%set_known_motions(model, constraints, rates, fields)
      if (.not. rates) call open_up(self, model, fields)
      do pass = 1, most_passes
         ! Rates begin at rest: nothing to measure by yet.
         at_rest = rates .and. pass == 1
         if (.not. at_rest) then
            call find_scales(model, fields, first, scales)
            if (pass == 1) first = scales
         end if
         call self%find_residual(model, constraints, rates, fields, scales, residual)
         if (at_rest) residual = huge(1.0_wp)
         if (residual <= fine) exit
         if (pass > 3 .and. residual <= fair) exit
         if (pass > 1 .or. .not. rates) self%refinements = self%refinements + 1
         call self%correct(model, constraints, rates, scales, fields, singular)
         if (singular) return
      end do
      singular = .not. residual <= fair
      do i = 1, motion_count
         if (.not. model%moves(i)) cycle
         load = constraints%load(i)
         value = model%resultant(i, fields%pressure, fields%shear)
         if (load%control == control_force .and. self%motion_place(i) > 0) value = merge(load%rate, load%value, rates)
         fields%force(i) = value
      end do
   end subroutine refine

   !> Motions that are not among the unknowns, with what they do to the displacements.
   subroutine set_known_motions(self, model, constraints, rates, fields)
      class(reduced_system_type), intent(in) :: self
      type(contact_model_type), intent(in) :: model
      type(constraints_type), intent(in) :: constraints
      logical, intent(in) :: rates
      type(contact_fields_type), intent(inout) :: fields
      type(load_type) :: load
      integer :: i

      if (all(self%motion_place > 0)) return
      if (model%has_rigid_parts()) then
         fields%normal = fields%normal + model%rigid_normal(fields)
         fields%tangential = fields%tangential + model%rigid_tangential(fields)
      end if
      do i = 1, motion_count
         if (self%motion_place(i) > 0 .or. .not. model%moves(i)) cycle
         load = constraints%load(i)
         fields%motion(i) = merge(load%rate, load%value, rates)
      end do
      if (model%has_rigid_parts()) then
         fields%normal = fields%normal - model%rigid_normal(fields)
         fields%tangential = fields%tangential - model%rigid_tangential(fields)
      end if
   end subroutine set_known_motions

   !> No tractions on nodes without unknowns.
   subroutine open_up(self, model, fields)
      class(reduced_system_type), intent(in) :: self
      type(contact_model_type), intent(in) :: model
      type(contact_fields_type), intent(inout) :: fields
      real(wp), parameter :: nothing = 1.0e-14_wp
      real(wp) :: largest, scale
      integer :: i

      scale = 0.0_wp
      largest = 0.0_wp
      do i = 1, size(fields%pressure)
         scale = max(scale, abs(fields%pressure(i)), abs(fields%shear(i)))
         if (self%place(i, a_pressure) == 0) then
            largest = max(largest, abs(fields%pressure(i)))
            fields%pressure(i) = 0.0_wp
         end if
         if (self%place(i, a_shear) == 0) then
            largest = max(largest, abs(fields%shear(i)))
            fields%shear(i) = 0.0_wp
         end if
      end do
      if (largest <= nothing*scale) return
      call model%displace(fields)
   end subroutine open_up

   !> What is missing in every row and constraint, in their units, as right sides for a correction; and the largest of them, in
   !> parts of the magnitude of their sort.
   subroutine find_residual(self, model, constraints, rates, fields, scales, largest)
      class(reduced_system_type), intent(inout) :: self
      type(contact_model_type), intent(in) :: model
      type(constraints_type), intent(in) :: constraints
      logical, intent(in) :: rates
      type(contact_fields_type), intent(in) :: fields
      type(scales_type), intent(in) :: scales
      real(wp), intent(out) :: largest
      real(wp) :: length, modulus, interval, missing, value, by_length, by_stress, gap_rest, slip_rest, traction_rest, stiffness
      type(load_type) :: load
      integer :: i, node, p

      length = self%length
      modulus = model%compliance%modulus
      interval = model%interval()
      by_length = 1.0_wp/length
      by_stress = 1.0_wp/(interval*modulus)
      gap_rest = 0.0_wp
      slip_rest = 0.0_wp
      traction_rest = 0.0_wp
      largest = 0.0_wp
      do p = 1, 2
         associate (part => self%part(p))
            if (size(part%values) < part%system%constraints) then
               deallocate (part%values)
               allocate (part%values(2*part%system%constraints))
            end if
            do i = 1, part%unknowns
               node = part%of(i)
               if (part%sort(i) == a_pressure) then
                  missing = fields%motion(motion_approach) - fields%normal(node)
                  if (.not. rates) then
                     missing = missing - model%initial_gap(node)
                  else if (allocated(constraints%gap_rate)) then
                     missing = missing + constraints%gap_rate(node)
                  end if
                  gap_rest = max(gap_rest, abs(missing))
                  part%right(i) = missing*by_length
               else if (part%sort(i) == a_motion) then
                  load = constraints%load(node)
                  value = merge(load%rate, load%value, rates)
                  if (self%motion_constraint(node) > 0) then
                     value = (value - fields%motion(node))*arm_unit(node, length)
                     largest = max(largest, relative(abs(value), scales%normal))
                     part%values(self%motion_constraint(node)) = value*by_length
                     part%right(i) = 0.0_wp
                  else
                     missing = (model%resultant(node, fields%pressure, fields%shear) - value)/arm_unit(node, length)
                     largest = max(largest, relative(abs(missing), merge(scales%shear_force, scales%force, &
                                                                         node == motion_shift)))
                     part%right(i) = missing*by_stress
                  end if
               else if (constraints%status(node) == node_stick) then
                  missing = fields%motion(motion_shift) - fields%tangential(node)
                  if (.not. rates) then
                     missing = missing + constraints%stuck_slip(node)
                  else if (allocated(constraints%slip_rate)) then
                     missing = missing + constraints%slip_rate(node)
                  end if
                  slip_rest = max(slip_rest, abs(missing))
                  part%right(i) = missing*by_length
               else
                  value = missing_shear(constraints, rates, fields, node)
                  stiffness = abs(constraints%row(node)%stiffness)
                  if (stiffness > 0.0_wp) then
                     ! Its slip is known as well as that of a stuck node.
                     largest = max(largest, abs(value)/max(scales%traction, stiffness*scales%tangential))
                  else
                     traction_rest = max(traction_rest, abs(value))
                  end if
                  part%values(self%constraint_of(node)) = value*model%width(node)*by_stress
                  part%right(i) = 0.0_wp
               end if
            end do
         end associate
      end do
      largest = max(largest, gap_rest/scales%normal, slip_rest/scales%tangential, traction_rest/scales%traction)
   end subroutine find_residual

   !> Magnitudes of the fields. Where these become zero, or bodies only slide on each other, what is left is round-off and no
   !> measure: magnitudes count as at least a very small part of the `first` ones, and of what displacements could bring.
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
      if (model%has_rigid_parts()) &
         normal = max(normal, abs(fields%motion(motion_shift)), abs(fields%motion(motion_rotation))*model%length())
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
      tangential = max(tangential, model%grip*normal)
      normal = max(normal, tangential)
      possible = least*model%compliance%modulus*normal
      traction = max(traction, possible/model%length())
      force = max(force, least*first%force, possible)
      shear_force = max(shear_force, model%grip*force, least*first%shear_force)
      scales = scales_type(normal, tangential, traction, max(force, shear_force), shear_force)
   end subroutine find_scales

   !> A magnitude over its scale, or the largest real where that is less: of a load on a contact that carries nothing yet.
   pure real(wp) function relative(magnitude, scale)
      real(wp), intent(in) :: magnitude, scale

      relative = huge(1.0_wp)
      if (magnitude < min(scale, 1.0_wp)*huge(1.0_wp)) relative = magnitude/scale
   end function relative

   !> What is missing to the shear traction of a slipping or creeping node.
   pure real(wp) function missing_shear(constraints, rates, fields, node)
      type(constraints_type), intent(in) :: constraints
      logical, intent(in) :: rates
      type(contact_fields_type), intent(in) :: fields
      integer, intent(in) :: node

      associate (row => constraints%row(node))
         missing_shear = row%slope*fields%pressure(node) - fields%shear(node)
         if (abs(row%stiffness) > 0.0_wp) &
            missing_shear = missing_shear + row%stiffness*(fields%tangential(node) - fields%motion(motion_shift))
         missing_shear = missing_shear + merge(constraints%offset_rate(node), row%offset, rates)
      end associate
   end function missing_shear

   !> Solve for a correction by the residuals found, and apply it.
   subroutine correct(self, model, constraints, rates, scales, fields, singular)
      class(reduced_system_type), intent(inout) :: self
      type(contact_model_type), intent(in) :: model
      type(constraints_type), intent(in) :: constraints
      logical, intent(in) :: rates
      type(scales_type), intent(in) :: scales
      type(contact_fields_type), intent(inout) :: fields
      logical, intent(out) :: singular
      real(wp) :: residual
      integer :: p

      singular = .false.
      do p = 1, 2
         if (self%part(p)%unknowns == 0) cycle
         if (p == 2) call self%find_residual(model, constraints, rates, fields, scales, residual)
         associate (part => self%part(p), n => self%part(p)%unknowns)
            call part%system%solve(part%right(:n), part%values(:part%system%constraints), part%solution(:n), singular)
            ! Of what is no number the residual would see nothing.
            if (.not. singular) singular = .not. all(abs(part%solution(:n)) <= huge(1.0_wp))
         end associate
         if (singular) return
         call apply(self, model, constraints, rates, p, fields)
         if (self%apart .and. p == 1 .and. self%part(2)%unknowns > 0 .and. .not. self%block(block_up)) cycle
         call model%displace(fields)
      end do
   end subroutine correct

   !> Add the solution of a part to the fields; tractions of slipping nodes are what their lines say.
   subroutine apply(self, model, constraints, rates, p, fields)
      class(reduced_system_type), intent(in) :: self
      type(contact_model_type), intent(in) :: model
      type(constraints_type), intent(in) :: constraints
      logical, intent(in) :: rates
      integer, intent(in) :: p
      type(contact_fields_type), intent(inout) :: fields
      real(wp) :: unit
      integer :: i, node

      associate (part => self%part(p), stress => model%compliance%modulus*model%interval())
         do i = 1, part%unknowns
            node = part%of(i)
            if (part%sort(i) == a_motion) then
               fields%motion(node) = fields%motion(node) + part%solution(i)*self%length/arm_unit(node, self%length)
               cycle
            end if
            unit = stress/model%width(node)
            if (part%sort(i) == a_pressure) then
               fields%pressure(node) = fields%pressure(node) + unit*part%solution(i)
            else
               fields%shear(node) = fields%shear(node) + unit*part%solution(i)
            end if
         end do
         do i = 1, size(self%constraint_of)
            if (self%constraint_of(i) == 0 .or. p /= self%part_of(a_shear, i)) cycle
            if (abs(constraints%row(i)%stiffness) > 0.0_wp) cycle
            fields%shear(i) = fields%shear(i) + missing_shear(constraints, rates, fields, i)
         end do
      end associate
   end subroutine apply

end module mfv_reduced_system
