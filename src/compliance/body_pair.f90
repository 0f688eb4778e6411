!> Compliance of two bodies in contact, for the contact algorithms.
!>
!> The upper body is the mirror image of a lower one, with the tractions p and -tau. With w and u from the compliance of each
!> body the gap closes by w1 + w2 and the slip is u1 - u2, so that
!>
!>     C_wp = C1_wp + C2_wp,  C_wt = C1_wt - C2_wt,  C_up = C1_up - C2_up,  C_ut = C1_ut + C2_ut.
!>
!> A rigid body contributes nothing. Bodies of equal signature (shape and material) do not couple: C_wt and C_up of the pair
!> vanish and do not exist, but the bodies' own blocks do.
module mfv_body_pair
   use mfv_compliance
   use mfv_kinds, only: wp
   implicit none
   private
   public :: body_pair_type, new_body_pair, lower_body, upper_body

   integer, parameter :: lower_body = 1, upper_body = 2

   !> A body of the pair; unallocated if rigid.
   type :: member_type
      class(compliance_type), allocatable :: compliance
   end type member_type

   type, extends(compliance_type) :: body_pair_type
      type(member_type) :: body(2)
   contains
      procedure :: resize
      procedure :: entries
      procedure :: products
      procedure :: displacements
      procedure :: normal_by_shear
      procedure :: tangential_displacements
      procedure :: deforms
      procedure :: body_displacements
   end type body_pair_type

   !> Signs of the upper body's blocks.
   real(wp), parameter :: upper_sign(4) = [1.0_wp, -1.0_wp, -1.0_wp, 1.0_wp]

contains

   !> Pair of a lower and an upper body on the same intervals; unallocated if rigid. At least one is elastic. Both are moved
   !> into the pair.
   subroutine new_body_pair(lower, upper, self)
      class(compliance_type), allocatable, intent(inout) :: lower, upper
      type(body_pair_type), intent(out) :: self
      real(wp) :: flexibility, by_shear
      integer :: i

      call move_alloc(lower, self%body(lower_body)%compliance)
      call move_alloc(upper, self%body(upper_body)%compliance)
      flexibility = 0.0_wp
      by_shear = 0.0_wp
      self%is_homogeneous = .true.
      self%by_distance = .true.
      do i = 1, 2
         if (.not. self%deforms(i)) cycle
         associate (body => self%body(i)%compliance)
            self%nodes = body%nodes
            self%interval = body%interval
            self%has_block = self%has_block .or. body%has_block
            self%elastic_block = self%elastic_block .or. body%elastic_block
            self%block_values = self%block_values + body%block_values
            flexibility = flexibility + 1.0_wp/body%modulus
            by_shear = by_shear + body%shear_ratio/body%modulus
            self%kernel_error = max(self%kernel_error, body%kernel_error)
            self%is_homogeneous = self%is_homogeneous .and. body%is_homogeneous
            self%by_distance = self%by_distance .and. body%by_distance
         end associate
      end do
      self%modulus = 1.0_wp/flexibility
      self%shear_ratio = by_shear/flexibility
      if (couples(self)) return
      self%has_block([block_wt, block_up]) = .false.
      self%elastic_block([block_wt, block_up]) = .false.
   end subroutine new_body_pair

   !> Whether coupling blocks remain.
   pure logical function couples(self)
      type(body_pair_type), intent(in) :: self
      real(wp) :: signature(4, 2)
      integer :: i

      signature = 0.0_wp
      do i = 1, 2
         if (self%deforms(i)) signature(:, i) = self%body(i)%compliance%signature()
      end do
      couples = .not. all(abs(signature(:, 1) - signature(:, 2)) <= 0.0_wp)
   end function couples

   !> Whether the lower (lower_body) or upper (upper_body) body is elastic.
   pure logical function deforms(self, side)
      class(body_pair_type), intent(in) :: self
      integer, intent(in) :: side

      deforms = allocated(self%body(side)%compliance)
   end function deforms

   !> See mfv_compliance.
   subroutine resize(self, nodes)
      class(body_pair_type), intent(inout) :: self
      integer, intent(in) :: nodes
      integer :: i

      self%nodes = nodes
      self%block_values = 0
      do i = 1, 2
         if (.not. self%deforms(i)) cycle
         call self%body(i)%compliance%resize(nodes)
         self%block_values = self%block_values + self%body(i)%compliance%block_values
      end do
   end subroutine resize

   !> See mfv_compliance.
   pure subroutine entries(self, block, rows, columns, matrix)
      class(body_pair_type), intent(in) :: self
      integer, intent(in) :: block, rows(:), columns(:)
      real(wp), intent(out) :: matrix(:, :)
      real(wp), allocatable :: upper(:, :)

      if (.not. self%deforms(upper_body)) then
         call self%body(lower_body)%compliance%entries(block, rows, columns, matrix)
         return
      end if
      matrix = 0.0_wp
      if (self%deforms(lower_body)) call self%body(lower_body)%compliance%entries(block, rows, columns, matrix)
      allocate (upper(size(rows), size(columns)))
      call self%body(upper_body)%compliance%entries(block, rows, columns, upper)
      matrix = matrix + upper_sign(block)*upper
   end subroutine entries

   !> See mfv_compliance.
   subroutine products(self, pressure, shear, by_block)
      class(body_pair_type), intent(in) :: self
      real(wp), intent(in) :: pressure(:), shear(:)
      real(wp), intent(out) :: by_block(:, :)
      real(wp) :: upper(size(pressure), 4)
      integer :: block

      if (self%deforms(lower_body)) call self%body(lower_body)%compliance%products(pressure, shear, by_block)
      if (self%deforms(upper_body)) then
         call self%body(upper_body)%compliance%products(pressure, shear, upper)
         do block = 1, 4
            upper(:, block) = upper_sign(block)*upper(:, block)
         end do
         if (self%deforms(lower_body)) upper = by_block + upper
         by_block = upper
         ! Those of equal bodies cancel.
         if (.not. self%has_block(block_wt)) by_block(:, block_wt) = 0.0_wp
         if (.not. self%has_block(block_up)) by_block(:, block_up) = 0.0_wp
      end if
   end subroutine products

   !> See mfv_compliance: of layers by the displacements of the bodies, each in one product.
   subroutine displacements(self, pressure, shear, normal, tangential)
      class(body_pair_type), intent(in) :: self
      real(wp), intent(in) :: pressure(:), shear(:)
      real(wp), intent(out) :: normal(:), tangential(:)
      real(wp), dimension(size(pressure)) :: upper_normal, upper_tangential
      real(wp) :: by_block(size(pressure), 4)

      if (self%is_homogeneous .or. .not. (self%by_distance .and. all(self%has_block))) then
         call self%products(pressure, shear, by_block)
         normal = by_block(:, block_wp) + by_block(:, block_wt)
         tangential = by_block(:, block_ut) + by_block(:, block_up)
         return
      end if
      call self%body_displacements(lower_body, pressure, shear, normal, tangential)
      call self%body_displacements(upper_body, pressure, shear, upper_normal, upper_tangential)
      normal = normal + upper_normal
      tangential = tangential - upper_tangential
   end subroutine displacements

   !> See mfv_compliance.
   subroutine normal_by_shear(self, shear, normal)
      class(body_pair_type), intent(in) :: self
      real(wp), intent(in) :: shear(:)
      real(wp), intent(out) :: normal(:)
      real(wp) :: by_body(size(shear))
      integer :: i

      normal = 0.0_wp
      if (.not. self%has_block(block_wt)) return
      do i = 1, 2
         if (.not. self%deforms(i)) cycle
         call self%body(i)%compliance%normal_by_shear(shear, by_body)
         normal = normal + merge(1.0_wp, upper_sign(block_wt), i == lower_body)*by_body
      end do
   end subroutine normal_by_shear

   !> See mfv_compliance. The effect of pressure has the opposite sign on the upper body.
   subroutine tangential_displacements(self, pressure, shear, tangential)
      class(body_pair_type), intent(in) :: self
      real(wp), intent(in) :: pressure(:), shear(:)
      real(wp), intent(out) :: tangential(:)
      real(wp) :: by_body(size(shear)), factor
      integer :: i

      tangential = 0.0_wp
      do i = 1, 2
         if (.not. self%deforms(i)) cycle
         factor = merge(1.0_wp, upper_sign(block_up), i == lower_body)
         ! The effects of pressure on equal bodies cancel.
         if (.not. self%has_block(block_up)) factor = 0.0_wp
         call self%body(i)%compliance%tangential_displacements(factor*pressure, shear, by_body)
         tangential = tangential + by_body
      end do
   end subroutine tangential_displacements

   !> Surface displacements of one body, into it and to the right, length, by the tractions on the lower body; zero for a
   !> rigid one. Shapes (nodes).
   subroutine body_displacements(self, side, pressure, shear, normal, tangential)
      class(body_pair_type), intent(in) :: self
      integer, intent(in) :: side
      real(wp), intent(in) :: pressure(:), shear(:)
      real(wp), intent(out) :: normal(:), tangential(:)

      normal = 0.0_wp
      tangential = 0.0_wp
      if (.not. self%deforms(side)) return
      call self%body(side)%compliance%displacements(pressure, merge(shear, -shear, side == lower_body), normal, tangential)
   end subroutine body_displacements

end module mfv_body_pair
