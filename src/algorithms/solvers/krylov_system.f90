!> State and rates without a stored matrix, in memory O(n): products with the compliance through FFTW, and Krylov iteration.
!>
!> Unknowns are the pressures of the nodes in contact, the shear tractions of the held nodes and the motions of the upper body
!> under force control. Held nodes are the stuck ones and those whose friction line depends on slip; the others slip, and their
!> shear tau = slope*p + offset is inserted into the rows of elasticity. Rows, with the arms a of the motions y:
!>
!>     C_wp p + C_wt tau - a_w y              = -g0              nodes in contact
!>     C_up p + C_ut tau - a_u y              = s0               stuck nodes
!>     C_up p + C_ut tau - a_u y + c (tau - slope p) = c offset  tau = slope*p + stiffness*s + offset, softness c = -1/stiffness
!>     resultants of p and tau                = P, Q, M          free motions
!>
!> The row of a stuck node at a front has w times the slip of another node subtracted on its left side (front_type).
!>
!> The preconditioner is block triangular: pressures by the inverse of C_wp (mfv_krylov_preconditioner), then shear tractions by
!> that of C_ut after subtracting the effect of these pressures; on several patches, where these inverses are not exact, it is
!> block diagonal, which takes more iterations (a sixth to a third), but one product less in each. The free motions follow from a
!> Schur complement of at most three rows. GMRES is applied to the preconditioned rows: up to the coupling its residual is the
!> error of the unknowns, and `linear_tolerance` is the relative error of tractions and motions (2-norms). On consecutive nodes the
!> number of iterations does not depend on that of nodes: about 12 for nu = 0.3 and mu = 0.5, about 36 for nu = 0 and mu = 3.
module mfv_krylov_system
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use mfv_compliance, only: block_up, block_wt
   use mfv_contact_fields, only: contact_fields_type
   use mfv_contact_model, only: contact_model_type
   use mfv_contact_system
   use mfv_gmres, only: gmres_type
   use mfv_kinds, only: wp
   use mfv_lapack, only: dgesv
   use mfv_krylov_preconditioner, only: krylov_preconditioner_type
   use mfv_motions, only: motion_count, motion_shift, motion_wear, control_force, arm_unit
   use mfv_node_status
   use mfv_reduced_system, only: reduced_system_type
   use mfv_tolerances, only: rounding, significant
   implicit none
   private
   public :: krylov_system_type

   !> Prescribed values of the state or of the rates, in the units of the system.
   type :: right_side_type
      !> The right-hand sides of all rows, shape (unknowns).
      real(wp), allocatable :: rows(:)
      !> Offsets of the slip lines, shape (nodes).
      real(wp), allocatable :: offset(:)
      !> Prescribed motions, and zero for the free ones.
      real(wp) :: motion(motion_count) = 0.0_wp
   end type right_side_type

   !> Rates as a first guess of later ones.
   type :: rates_type
      !> Tractions, shape (nodes), and motions, in the units of the system; the rates of the loads.
      real(wp), allocatable :: pressure(:), shear(:)
      real(wp), dimension(motion_count) :: motion = 0.0_wp, load = 0.0_wp
   end type rates_type

   type, extends(contact_system_type) :: krylov_system_type
      private
      type(krylov_preconditioner_type) :: preconditioner
      type(gmres_type) :: gmres
      !> Units of traction, length, arms and motions.
      real(wp) :: stress = 1.0_wp, length = 0.0_wp, arm(motion_count) = 1.0_wp, motion_unit(motion_count) = 1.0_wp
      !> Arms of the motions and widths of the nodes in these units, shapes (nodes, motion_count), (nodes).
      real(wp), allocatable :: normal_arm(:, :), tangential_arm(:, :), width(:)
      !> Nodes in contact, held nodes, and free motions, ascending.
      integer, allocatable :: contact(:), held(:), free(:)
      !> Slopes of slipping nodes, zero for others, shape (nodes).
      real(wp), allocatable :: slope(:)
      !> Softness and slope of the held nodes, shape (held).
      real(wp), allocatable :: softness(:), held_slope(:)
      !> What the slip of the held nodes depends on, shape (held); not allocated: nothing.
      type(front_type), allocatable :: front(:)
      !> Whether pressures act on the rows of held nodes.
      logical :: coupled = .false.
      !> Rows of the resultants and preconditioned columns of the free motions, shape (contact + held, free), and the Schur
      !> complement, shape (free, free).
      real(wp), allocatable :: resultants(:, :), columns(:, :), schur(:, :)
      !> Tractions and displacements of the last product, shape (nodes); and those of the last residual: pressure, shear, normal,
      !> tangential, shape (nodes, 4).
      real(wp), allocatable :: pressure(:), shear(:), normal(:), tangential(:), found(:, :)
      !> The last rates of each kind.
      type(rates_type) :: last(kinds_of_rates)
      !> Where the iteration fails.
      type(reduced_system_type), allocatable :: direct
   contains
      procedure :: solve
   end type krylov_system_type

   !> Most nodes in contact for the reduced system where the iteration fails: 200 MB.
   integer, parameter :: most_direct = 2000
   !> Most restarts of the iteration.
   integer, parameter :: most_passes = 20
   !> Factor on the tolerance for single nodes, since the iteration controls the 2-norm only.
   real(wp), parameter :: margin = 4.0_wp

contains

   !> See mfv_contact_system. Where the iteration fails, the reduced system takes over, unless its matrix would be too large.
   subroutine solve(self, model, constraints, start, response, singular)
      class(krylov_system_type), intent(inout) :: self
      type(contact_model_type), intent(in) :: model
      type(constraints_type), intent(in) :: constraints
      type(contact_fields_type), intent(in) :: start
      type(response_type), intent(inout) :: response
      logical, intent(out) :: singular

      self%solves = self%solves + 1
      self%gave_up = .false.
      call solve_by_iteration(self, model, constraints, start, response, singular)
      if (.not. singular) return
      self%gave_up = size(self%contact) > most_direct
      if (self%gave_up) return
      if (.not. allocated(self%direct)) allocate (self%direct)
      call self%direct%solve(model, constraints, start, response, singular)
   end subroutine solve

   !> Solve by iteration. `fails`: it does not converge, or the constraints do not determine the fields.
   subroutine solve_by_iteration(self, model, constraints, start, response, fails)
      class(krylov_system_type), intent(inout) :: self
      type(contact_model_type), intent(in) :: model
      type(constraints_type), intent(in) :: constraints
      type(contact_fields_type), intent(in) :: start
      type(response_type), intent(inout) :: response
      logical, intent(out) :: fails
      type(prescribed_type) :: prescribed
      type(right_side_type) :: right
      real(wp), allocatable :: unknowns(:)
      real(wp) :: error

      self%tolerance = margin*max(model%scene%method%linear_tolerance, constraints%allowed)
      self%rate_tolerance = max(self%tolerance, margin*constraints%allowed_in_rates)
      call fit_to_mesh(self, model)
      call choose_unknowns(self, model, constraints)
      call prepare_preconditioner(self, model, fails)
      if (fails) return

      if (constraints%rates_only) then
         call response%state%copy_from(start)
      else
         call find_prescribed(constraints, model, .false., prescribed)
         right = right_side(self, model, constraints%status, prescribed)
         unknowns = [start%pressure(self%contact)/self%stress, start%shear(self%held)/self%stress, &
                     start%motion(self%free)/self%motion_unit(self%free)]
         call iterate(self, model, right, self%tolerance/margin, unknowns, fails, error)
         if (fails) return
         self%tolerance = min(self%tolerance, margin*max(model%scene%method%linear_tolerance, error))
         call set_fields(self, model, prescribed, right, unknowns, response%state)
      end if

      call find_prescribed(constraints, model, .true., prescribed)
      right = right_side(self, model, constraints%status, prescribed)
      associate (last => self%last(constraints%kind))
         unknowns = proportion(last%load, constraints%load%rate) &
                    *[last%pressure(self%contact), last%shear(self%held), last%motion(self%free)]
      end associate
      call iterate(self, model, right, max(model%scene%method%linear_tolerance, constraints%allowed, &
                                           merge(0.0_wp, constraints%allowed_in_rates, constraints%kind == rates_of_loads)), &
                   unknowns, fails, error)
      if (fails) return
      call set_fields(self, model, prescribed, right, unknowns, response%rate)
      associate (last => self%last(constraints%kind))
         last%pressure = self%found(:, 1)
         last%shear = self%found(:, 2)
         last%motion = motion_of(self, right%motion, unknowns)
         last%load = constraints%load%rate
      end associate
   end subroutine solve_by_iteration

   !> The ratio of the rates of all loads `now` to those `before`; 1 where they are not in proportion.
   pure real(wp) function proportion(before, now) result(ratio)
      real(wp), intent(in) :: before(:), now(:)
      integer :: first

      ratio = 1.0_wp
      first = findloc(abs(before) > 0.0_wp, .true., dim=1)
      if (first == 0) return
      if (all(abs(now - now(first)/before(first)*before) <= significant*abs(now))) ratio = now(first)/before(first)
   end function proportion

   !> Set units, arms and work space for the present mesh; move the last rates to a mesh that has grown.
   subroutine fit_to_mesh(self, model)
      class(krylov_system_type), intent(inout) :: self
      type(contact_model_type), intent(in) :: model
      integer :: i, n

      n = model%nodes()
      if (.not. self%length > 0.0_wp) then
         self%length = model%length()
         self%stress = model%compliance%modulus
         self%arm = [(arm_unit(i, self%length, self%stress), i=1, motion_count)]
         self%motion_unit = self%length/self%arm
      end if
      call self%preconditioner%prepare(model%compliance, self%length/self%stress)
      if (allocated(self%pressure)) then
         if (size(self%pressure) == n) then
            self%normal_arm(:, motion_wear) = model%normal_arm(:, motion_wear)/self%arm(motion_wear)
            return
         end if
         deallocate (self%pressure, self%shear, self%normal, self%tangential, self%found)
      end if
      allocate (self%pressure(n), self%shear(n), self%normal(n), self%tangential(n), self%found(n, 4), source=0.0_wp)
      self%normal_arm = model%normal_arm
      self%tangential_arm = model%tangential_arm
      do i = 1, motion_count
         self%normal_arm(:, i) = self%normal_arm(:, i)/self%arm(i)
         self%tangential_arm(:, i) = self%tangential_arm(:, i)/self%arm(i)
      end do
      self%width = model%width/self%length
      do i = 1, kinds_of_rates
         associate (last => self%last(i))
            call widen(last%pressure, n)
            call widen(last%shear, n)
         end associate
      end do
   end subroutine fit_to_mesh

   !> Extend values to a mesh of `n` nodes that has grown equally at either end.
   subroutine widen(values, n)
      real(wp), allocatable, intent(inout) :: values(:)
      integer, intent(in) :: n
      real(wp), allocatable :: wider(:)
      integer :: extra

      allocate (wider(n), source=0.0_wp)
      if (allocated(values)) then
         extra = (n - size(values))/2
         if (extra >= 0) wider(extra + 1:extra + size(values)) = values
      end if
      call move_alloc(wider, values)
   end subroutine widen

   !> Choose the nodes and motions with unknowns, and the friction lines.
   subroutine choose_unknowns(self, model, constraints)
      class(krylov_system_type), intent(inout) :: self
      type(contact_model_type), intent(in) :: model
      type(constraints_type), intent(in) :: constraints
      logical, dimension(size(constraints%status)) :: is_held, follows
      real(wp), dimension(size(constraints%status)) :: stiffness
      logical :: free(motion_count)
      integer :: i, n

      n = size(constraints%status)
      follows = slips(constraints%status) .or. creeps(constraints%status)
      stiffness = 0.0_wp
      where (follows) stiffness = constraints%row%stiffness*(self%length/self%stress)
      where (abs(stiffness) <= rounding) stiffness = 0.0_wp
      is_held = constraints%status == node_stick .or. abs(stiffness) > 0.0_wp
      self%contact = pack([(i, i=1, n)], in_contact(constraints%status))
      self%held = pack([(i, i=1, n)], is_held)
      self%slope = merge(constraints%row%slope, 0.0_wp, follows .and. .not. is_held)
      self%held_slope = merge(constraints%row(self%held)%slope, 0.0_wp, follows(self%held))
      if (allocated(self%front)) deallocate (self%front)
      if (allocated(constraints%front)) self%front = constraints%front(self%held)
      self%softness = 0.0_wp*self%held_slope
      where (follows(self%held)) self%softness = -1.0_wp/stiffness(self%held)
      self%coupled = model%compliance%has_block(block_up) .or. any(abs(self%slope) > 0.0_wp) .or. &
                     any(abs(self%held_slope) > 0.0_wp)
      self%coupled = self%coupled .and. size(self%held) > 0

      free = constraints%load%control == control_force .and. model%moves
      free(motion_shift) = free(motion_shift) .and. (any(is_held) .or. any(follows))
      self%free = pack([(i, i=1, motion_count)], free)
   end subroutine choose_unknowns

   !> Prepare the preconditioner for these unknowns. `singular`: the free motions are not determined.
   subroutine prepare_preconditioner(self, model, singular)
      class(krylov_system_type), intent(inout) :: self
      type(contact_model_type), intent(in) :: model
      logical, intent(out) :: singular
      real(wp), parameter :: no_pivot = 1.0e-13_wp
      real(wp) :: scaled(size(self%free), size(self%free))
      integer :: i, j, m

      call self%preconditioner%set_contact(self%contact)
      call self%preconditioner%set_held(self%held, self%softness)
      m = size(self%contact)
      if (allocated(self%columns)) deallocate (self%resultants, self%columns, self%schur)
      allocate (self%resultants(m + size(self%held), size(self%free)))
      allocate (self%columns, mold=self%resultants)
      do j = 1, size(self%free)
         associate (normal => self%normal_arm(self%contact, self%free(j)), tangential => self%tangential_arm(:, self%free(j)))
            self%columns(:m, j) = -normal
            self%columns(m + 1:, j) = -tangential(self%held)
            self%resultants(:m, j) = self%width(self%contact)*(normal + self%slope(self%contact)*tangential(self%contact))
            self%resultants(m + 1:, j) = self%width(self%held)*tangential(self%held)
         end associate
         call precondition_tractions(self, model, self%columns(:, j))
      end do
      self%schur = matmul(transpose(self%resultants), self%columns)
      singular = .false.
      do j = 1, size(self%free)
         do i = 1, size(self%free)
            singular = singular .or. .not. abs(self%schur(i, i)*self%schur(j, j)) > 0.0_wp
            if (.not. singular) scaled(i, j) = self%schur(i, j)/sqrt(abs(self%schur(i, i)*self%schur(j, j)))
         end do
      end do
      if (.not. singular) singular = smallest_pivot(scaled) < no_pivot
   end subroutine prepare_preconditioner

   !> The smallest pivot of a small matrix by complete elimination.
   pure real(wp) function smallest_pivot(matrix) result(smallest)
      real(wp), intent(in) :: matrix(:, :)
      real(wp) :: left(size(matrix, 1), size(matrix, 2))
      integer :: i, k, place(2)

      left = matrix
      smallest = huge(1.0_wp)
      do k = 1, size(left, 1)
         place = maxloc(abs(left))
         smallest = min(smallest, abs(left(place(1), place(2))))
         if (.not. smallest > 0.0_wp) return
         do i = 1, size(left, 1)
            if (i /= place(1)) left(i, :) = left(i, :) - left(i, place(2))/left(place(1), place(2))*left(place(1), :)
         end do
         left(place(1), :) = 0.0_wp
         left(:, place(2)) = 0.0_wp
      end do
   end function smallest_pivot

   !> The right-hand sides for the prescribed values and statuses.
   type(right_side_type) function right_side(self, model, status, prescribed) result(right)
      class(krylov_system_type), intent(in) :: self
      type(contact_model_type), intent(in) :: model
      integer, intent(in) :: status(:)
      type(prescribed_type), intent(in) :: prescribed

      right%motion = prescribed%load/self%motion_unit
      right%motion(self%free) = 0.0_wp
      where (.not. model%moves) right%motion = 0.0_wp
      right%offset = merge(prescribed%offset, 0.0_wp, slips(status) .or. creeps(status))/self%stress
      associate (held => self%held)
         right%rows = [prescribed%opening(self%contact)/self%length, &
                       merge(prescribed%slip(held)/self%length, self%softness*right%offset(held), status(held) == node_stick), &
                       prescribed%load(self%free)/(self%stress*self%length*self%arm(self%free))]
         right%offset(held) = 0.0_wp
      end associate
   end function right_side

   !> All motions: the free ones from the unknowns, the others `prescribed`.
   pure function motion_of(self, prescribed, unknowns) result(motion)
      class(krylov_system_type), intent(in) :: self
      real(wp), intent(in) :: prescribed(motion_count), unknowns(:)
      real(wp) :: motion(motion_count)

      motion = prescribed
      motion(self%free) = unknowns(size(self%contact) + size(self%held) + 1:)
   end function motion_of

   !> Iterate until the `unknowns` meet the relative `tolerance`; their `error` can be much smaller. `fails`: they do not meet it.
   !> `found` then belongs to them.
   subroutine iterate(self, model, right, tolerance, unknowns, fails, error)
      class(krylov_system_type), intent(inout) :: self
      type(contact_model_type), intent(in) :: model
      type(right_side_type), intent(in) :: right
      real(wp), intent(in) :: tolerance
      real(wp), intent(inout) :: unknowns(:)
      logical, intent(out) :: fails
      real(wp), intent(out) :: error
      real(wp), parameter :: progress = 0.5_wp, near_enough = 2.0_wp, drift = 1.0e-10_wp
      real(wp) :: rows(size(unknowns)), reached, before, scale, target
      integer :: pass
      logical :: done, checked

      fails = .false.
      error = 0.0_wp
      done = .false.
      ! If GMRES takes the inverses as exact, the round-off that their updates accumulate does not appear in its residual.
      checked = tolerance <= drift .and. inverts(self)
      before = huge(1.0_wp)
      target = 0.0_wp
      do pass = 1, most_passes
         call find_residual(self, model, right, unknowns, rows)
         if (done .and. .not. checked) return
         ! Rates in a large increment are zero.
         if (all(abs(rows) <= 0.0_wp)) return
         call precondition(self, model, rows)
         reached = norm2(rows)
         fails = .not. ieee_is_finite(reached)
         if (fails) return
         scale = norm2(unknowns)
         if (.not. scale > 0.0_wp) scale = reached
         target = target_of(self, right, tolerance*scale)
         error = reached/max(scale, tiny(1.0_wp))
         if (.not. model%compliance%has_block(block_wt)) call drop_accurate(self, target, rows)
         ! A guess within the tolerance is not changed.
         if (reached <= merge(near_enough, 1.0_wp, pass == 1)*target) return
         if (reached > progress*before) exit
         before = reached
         call improve(self, model, rows, target, unknowns, done)
         scale = norm2(unknowns)
         error = self%gmres%residual()/max(scale, tiny(1.0_wp))
         done = done .and. self%gmres%residual() <= target_of(self, right, tolerance*scale)
      end do
      fails = reached > max(significant*scale, 1.0e2_wp*target)
   end subroutine iterate

   !> Whether the preconditioner inverts the rows but for the coupling.
   pure logical function inverts(self)
      class(krylov_system_type), intent(in) :: self

      inverts = self%preconditioner%is_exact() .and. .not. allocated(self%front)
   end function inverts

   !> The residual at which the error of the unknowns is about `error`, or their round-off. Where the inverses are not exact, the
   !> residual is not the error; where friction decreases with slip, the rows can be nearly singular, and the error is larger.
   real(wp) function target_of(self, right, error) result(target)
      class(krylov_system_type), intent(in) :: self
      type(right_side_type), intent(in) :: right
      real(wp), intent(in) :: error
      real(wp), parameter :: of_approximation = 0.1_wp, of_weakening = 0.01_wp
      real(wp) :: part

      part = merge(1.0_wp, of_approximation, inverts(self))
      if (any(self%softness < 0.0_wp)) part = of_weakening
      target = max(part*error, round_off(self, right))
   end function target_of

   !> Set the residuals of pressures to zero if they are within the `target`, and those of motions without tangential displacements,
   !> so that what does not change costs nothing: without normal displacements by shear pressures are constant under a changing
   !> tangential load.
   pure subroutine drop_accurate(self, target, rows)
      class(krylov_system_type), intent(in) :: self
      real(wp), intent(in) :: target
      real(wp), intent(inout) :: rows(:)
      integer :: i, m

      m = size(self%contact)
      if (.not. norm2(rows(:m)) <= target) return
      rows(:m) = 0.0_wp
      do i = 1, size(self%free)
         associate (row => rows(m + size(self%held) + i))
            if (abs(row) <= target .and. .not. any(abs(self%tangential_arm(:, self%free(i))) > 0.0_wp)) row = 0.0_wp
         end associate
      end do
   end subroutine drop_accurate

   !> Error of the unknowns due to round-off of the displacements (2-norm).
   real(wp) function round_off(self, right)
      class(krylov_system_type), intent(in) :: self
      type(right_side_type), intent(in) :: right
      real(wp) :: largest

      largest = maxval(abs(right%motion))
      if (size(self%contact) > 0) largest = max(largest, maxval(abs(self%found(self%contact, 3))), &
                                                maxval(abs(right%rows(:size(self%contact)))))
      if (size(self%held) > 0) largest = max(largest, maxval(abs(self%found(self%held, 4))))
      round_off = epsilon(1.0_wp)*largest/self%preconditioner%smallest()*sqrt(real(size(right%rows), wp))
   end function round_off

   !> One GMRES cycle on the preconditioned residual `rows`; `done`: the target was reached.
   subroutine improve(self, model, rows, target, unknowns, done)
      class(krylov_system_type), intent(inout) :: self
      type(contact_model_type), intent(in) :: model
      real(wp), intent(inout) :: rows(:)
      real(wp), intent(in) :: target
      real(wp), intent(inout) :: unknowns(:)
      logical, intent(out) :: done
      real(wp) :: vector(size(rows))

      call self%gmres%start(rows)
      do while (self%gmres%residual() > target .and. .not. self%gmres%is_full())
         call self%gmres%direction(vector)
         call multiply_preconditioned(self, model, vector, rows)
         call self%gmres%extend(rows)
         self%iterations = self%iterations + 1
      end do
      call self%gmres%add_solution(unknowns)
      done = self%gmres%residual() <= target
   end subroutine improve

   !> Residual of the unknowns; their fields are stored in `found`.
   subroutine find_residual(self, model, right, unknowns, rows)
      class(krylov_system_type), intent(inout) :: self
      type(contact_model_type), intent(in) :: model
      type(right_side_type), intent(in) :: right
      real(wp), intent(in) :: unknowns(:)
      real(wp), intent(out) :: rows(:)

      call spread_tractions(self, unknowns)
      self%shear = self%shear + right%offset
      call displace(self, model)
      self%found(:, 1) = self%pressure
      self%found(:, 2) = self%shear
      self%found(:, 3) = self%normal
      self%found(:, 4) = self%tangential
      call collect_rows(self, motion_of(self, right%motion, unknowns), rows)
      rows = right%rows - rows
   end subroutine find_residual

   !> Product of the preconditioned matrix with a change of the unknowns. If the inverses are exact and there are no fronts, it is
   !> the change itself plus what the preconditioner leaves out: normal displacements by the shear, and those by resultants that
   !> depend on the datum.
   subroutine multiply_preconditioned(self, model, unknowns, rows)
      class(krylov_system_type), intent(inout) :: self
      type(contact_model_type), intent(in) :: model
      real(wp), intent(in) :: unknowns(:)
      real(wp), intent(out) :: rows(:)
      real(wp), parameter :: at_rest(motion_count) = 0.0_wp
      logical :: exact
      integer :: m, s

      call spread_tractions(self, unknowns)
      exact = inverts(self)
      if (exact) then
         m = size(self%contact)
         s = size(self%held)
         call model%compliance%normal_by_shear(self%shear, self%normal)
         rows(:m) = self%stress/self%length*self%normal(self%contact) + self%preconditioner%constant*sum(unknowns(:m))
         rows(m + 1:m + s) = self%preconditioner%shear_constant*sum(unknowns(m + 1:m + s))
         rows(m + s + 1:) = 0.0_wp
      else
         call displace(self, model)
         call collect_rows(self, motion_of(self, at_rest, unknowns), rows)
      end if
      call precondition(self, model, rows)
      if (exact) rows = rows + unknowns
   end subroutine multiply_preconditioned

   !> Tractions of all nodes from the unknowns; slipping nodes without offset.
   subroutine spread_tractions(self, unknowns)
      class(krylov_system_type), intent(inout) :: self
      real(wp), intent(in) :: unknowns(:)
      integer :: m

      m = size(self%contact)
      self%pressure = 0.0_wp
      self%pressure(self%contact) = unknowns(:m)
      self%shear = self%slope*self%pressure
      self%shear(self%held) = unknowns(m + 1:m + size(self%held))
   end subroutine spread_tractions

   !> Displacements by the tractions. Without tractions (rates in a large increment) they need no product.
   subroutine displace(self, model)
      class(krylov_system_type), intent(inout) :: self
      type(contact_model_type), intent(in) :: model
      real(wp) :: unit

      if (.not. (any(abs(self%pressure(self%contact)) > 0.0_wp) .or. any(abs(self%shear(self%contact)) > 0.0_wp))) then
         self%normal = 0.0_wp
         self%tangential = 0.0_wp
         return
      end if
      call model%compliance%displacements(self%pressure, self%shear, self%normal, self%tangential)
      unit = self%stress/self%length
      self%normal = unit*self%normal
      self%tangential = unit*self%tangential
      self%products = self%products + 1
   end subroutine displace

   !> Left-hand sides of all rows for the present tractions and displacements.
   subroutine collect_rows(self, motion, rows)
      class(krylov_system_type), intent(in) :: self
      real(wp), intent(in) :: motion(motion_count)
      real(wp), intent(out) :: rows(:)
      integer :: i, m, s

      m = size(self%contact)
      s = size(self%held)
      associate (held => self%held)
         rows(:m) = self%normal(self%contact)
         rows(m + 1:m + s) = self%tangential(held) + self%softness*(self%shear(held) - self%held_slope*self%pressure(held))
         do i = 1, motion_count
            if (.not. abs(motion(i)) > 0.0_wp) cycle
            rows(:m) = rows(:m) - self%normal_arm(self%contact, i)*motion(i)
            rows(m + 1:m + s) = rows(m + 1:m + s) - self%tangential_arm(held, i)*motion(i)
         end do
      end associate
      do i = 1, size(self%free)
         rows(m + s + i) = resultant(self, self%free(i))
      end do
      if (.not. allocated(self%front)) return
      do i = 1, s
         associate (front => self%front(i))
            if (front%node > 0) &
               rows(m + i) = rows(m + i) - front%weight*(self%tangential(front%node) &
                                                         - dot_product(self%tangential_arm(front%node, :), motion))
         end associate
      end do
   end subroutine collect_rows

   !> Resultant of the present tractions, as in mfv_contact_model.
   pure real(wp) function resultant(self, motion)
      class(krylov_system_type), intent(in) :: self
      integer, intent(in) :: motion

      associate (c => self%contact)
         resultant = sum(self%width(c)*(self%normal_arm(c, motion)*self%pressure(c) + self%tangential_arm(c, motion)*self%shear(c)))
      end associate
   end function resultant

   !> Approximate unknowns for the given rows; the free motions satisfy the resultants.
   subroutine precondition(self, model, rows)
      class(krylov_system_type), intent(inout) :: self
      type(contact_model_type), intent(in) :: model
      real(wp), intent(inout) :: rows(:)
      real(wp) :: motion(size(self%free)), factors(size(self%free), size(self%free))
      integer :: pivots(size(self%free)), i, info, n

      n = size(self%contact) + size(self%held)
      call precondition_tractions(self, model, rows(:n))
      if (size(self%free) == 0) return
      motion = [(dot_product(self%resultants(:, i), rows(:n)) - rows(n + i), i=1, size(self%free))]
      factors = self%schur
      call dgesv(size(motion), 1, factors, size(motion), pivots, motion, size(motion), info)
      rows(:n) = rows(:n) - matmul(self%columns, motion)
      rows(n + 1:) = motion
   end subroutine precondition

   !> Approximate tractions for the displacements in `rows`, shape (contact + held), without motions.
   subroutine precondition_tractions(self, model, rows)
      class(krylov_system_type), intent(inout) :: self
      type(contact_model_type), intent(in) :: model
      real(wp), intent(inout) :: rows(:)
      integer :: m

      m = size(self%contact)
      if (m == 0) return
      if (any(abs(rows(:m)) > 0.0_wp)) call self%preconditioner%apply_contact(rows(:m))
      if (size(self%held) == 0) return
      if (self%coupled .and. any(abs(rows(:m)) > 0.0_wp) .and. self%preconditioner%on_one_patch()) then
         self%pressure = 0.0_wp
         self%pressure(self%contact) = rows(:m)
         self%shear = self%slope*self%pressure
         call model%compliance%tangential_displacements(self%pressure, self%shear, self%tangential)
         self%products = self%products + 1
         rows(m + 1:) = rows(m + 1:) - self%stress/self%length*self%tangential(self%held) &
                        + self%softness*self%held_slope*self%pressure(self%held)
      end if
      if (any(abs(rows(m + 1:)) > 0.0_wp)) call self%preconditioner%apply_held(rows(m + 1:))
   end subroutine precondition_tractions

   !> Set fields to the tractions and displacements in `found` and the motions. Prescribed forces and motions are exact.
   subroutine set_fields(self, model, prescribed, right, unknowns, fields)
      class(krylov_system_type), intent(in) :: self
      type(contact_model_type), intent(in) :: model
      type(prescribed_type), intent(in) :: prescribed
      type(right_side_type), intent(in) :: right
      real(wp), intent(in) :: unknowns(:)
      type(contact_fields_type), intent(inout) :: fields
      integer :: i

      fields%motion = self%motion_unit*motion_of(self, right%motion, unknowns)
      fields%pressure = self%stress*self%found(:, 1)
      fields%shear = self%stress*self%found(:, 2)
      fields%normal = self%length*self%found(:, 3)
      fields%tangential = self%length*self%found(:, 4)
      if (model%has_rigid_parts()) then
         fields%normal = fields%normal - model%rigid_normal(fields)
         fields%tangential = fields%tangential - model%rigid_tangential(fields)
      end if
      fields%force = 0.0_wp
      do i = 1, motion_count
         if (.not. model%moves(i)) cycle
         if (any(self%free == i)) then
            fields%force(i) = prescribed%load(i)
         else
            fields%motion(i) = prescribed%load(i)
            fields%force(i) = model%resultant(i, fields%pressure, fields%shear)
         end if
      end do
   end subroutine set_fields

end module mfv_krylov_system
