!> Compliance of bonded layers on a half-plane or a rigid base under box tractions: that of a half-plane of the first layer
!> (mfv_half_plane), and what the layers below add, a smooth function of the distance (mfv_smooth_kernel).
module mfv_layered
   use mfv_compliance
   use mfv_half_plane, only: half_plane_type, new_half_plane
   use mfv_kernel_compliance, only: kernel_compliance_type
   use mfv_kinds, only: wp
   use mfv_layers, only: layers_type
   use mfv_near_field, only: near_field_type
   use mfv_smooth_kernel
   use mfv_toeplitz, only: new_toeplitz, toeplitz_type
   implicit none
   private
   public :: layered_type, new_layered

   type, extends(kernel_compliance_type) :: layered_type
      private
      type(layers_type) :: layers
      !> The first layer without a lower end, with one interval.
      type(half_plane_type) :: surface
      real(wp) :: datum = 1.0_wp, mixed_ratio = 0.0_wp
      type(smooth_kernel_type) :: smooth
      !> Equal intervals: the kernels by distance, shape (0:nodes - 1, smooth_kernels), and products with those of w by pressure and
      !> u by shear, with the mixed, with the odd one, and with all but the mixed one.
      real(wp), allocatable :: kernel(:, :)
      type(toeplitz_type) :: direct, mixed, odd, all
   contains
      procedure :: resize
      procedure :: kernels_at
      procedure :: entries
      procedure :: products
      procedure :: displacements
      procedure :: normal_by_shear
      procedure :: signature
   end type layered_type

contains

   !> Layers with `nodes` intervals of width `interval` (length); `constants`: of the near field of the first layer. Other
   !> arguments: see new_half_plane.
   type(layered_type) function new_layered(layers, constants, nodes, interval, datum, coupling, tangential, period, ends) &
      result(self)
      type(layers_type), intent(in) :: layers
      type(near_field_type), intent(in) :: constants
      integer, intent(in) :: nodes, coupling
      real(wp), intent(in) :: interval, datum, period
      logical, intent(in) :: tangential
      real(wp), intent(in), optional :: ends(:)

      self%layers = layers
      self%period = period
      self%interval = interval
      self%datum = datum
      self%modulus = constants%modulus()
      self%shear_ratio = constants%shear_ratio()
      self%mixed_ratio = constants%mixed/constants%normal
      self%surface = new_half_plane(constants, 1, interval, datum, coupling, tangential, period=period)
      call self%choose_blocks(coupling, tangential)
      self%nodes = nodes
      self%by_distance = .not. (present(ends) .or. period > 0.0_wp)
      if (present(ends)) then
         self%smooth = new_smooth_kernel(layers, datum, period, ends(size(ends)) - ends(1))
         self%kernel_error = self%smooth%error
         call self%grade(ends, odd=[.false., .false., .false., .true.])
      else
         call self%resize(nodes)
      end if
   end function new_layered

   !> See mfv_compliance.
   subroutine resize(self, nodes)
      class(layered_type), intent(inout) :: self
      integer, intent(in) :: nodes
      !> For more nodes later.
      real(wp), parameter :: room = 4.0_wp
      integer :: i

      self%nodes = nodes
      if (self%smooth%reach() < nodes*self%interval) &
         self%smooth = new_smooth_kernel(self%layers, self%datum, self%period, room*nodes*self%interval)
      self%kernel_error = self%smooth%error
      if (allocated(self%kernel)) deallocate (self%kernel)
      allocate (self%kernel(0:nodes - 1, smooth_kernels))
      do i = 0, nodes - 1
         call self%kernels_at(i*self%interval, self%interval, self%kernel(i, :))
      end do
      ! Else it is round-off.
      if (.not. self%layers%is_oblique()) self%kernel(:, mixed_kernel) = 0.0_wp
      self%direct = new_toeplitz(self%kernel(:, normal_kernel), other=self%kernel(:, tangential_kernel))
      self%odd = new_toeplitz(0.0_wp*self%kernel(:, odd_kernel), self%kernel(:, odd_kernel))
      self%all = new_toeplitz(self%kernel(:, normal_kernel), -self%kernel(:, odd_kernel), self%kernel(:, tangential_kernel))
      if (self%layers%is_oblique()) self%mixed = new_toeplitz(self%kernel(:, mixed_kernel))
      self%block_values = smooth_kernels*nodes
   end subroutine resize

   !> See mfv_kernel_compliance: the functions of mfv_smooth_kernel with those of the first layer.
   pure subroutine kernels_at(self, distance, width, kernels)
      class(layered_type), intent(in) :: self
      real(wp), intent(in) :: distance, width
      real(wp), intent(out) :: kernels(:)
      real(wp) :: surface(2)

      call self%surface%kernels_at(distance, width, surface)
      kernels = self%smooth%mean(distance, width)
      kernels([normal_kernel, tangential_kernel, mixed_kernel]) = kernels([normal_kernel, tangential_kernel, mixed_kernel]) &
                                                                  + [1.0_wp, self%shear_ratio, self%mixed_ratio]*surface(1)
      kernels(odd_kernel) = kernels(odd_kernel) + surface(2)
   end subroutine kernels_at

   !> See mfv_compliance.
   pure function signature(self)
      class(layered_type), intent(in) :: self
      real(wp) :: signature(4)
      real(wp), allocatable :: odd(:), mixed(:)

      if (allocated(self%mean)) then
         odd = pack(self%mean(:, :, odd_kernel), .true.)
         mixed = pack(self%mean(:, :, mixed_kernel), .true.)
      else
         odd = self%kernel(:, odd_kernel)
         mixed = self%kernel(:, mixed_kernel)
      end if
      signature = [sum(odd), norm2(odd), sum(mixed), norm2(mixed)]
   end function signature

   !> See mfv_compliance.
   pure subroutine entries(self, block, rows, columns, matrix)
      class(layered_type), intent(in) :: self
      integer, intent(in) :: block, rows(:), columns(:)
      real(wp), intent(out) :: matrix(:, :)
      integer :: even, j, odd

      even = mixed_kernel
      if (block == block_wp) even = normal_kernel
      if (block == block_ut) even = tangential_kernel
      odd = merge(1, -1, block == block_wt)
      do j = 1, size(columns)
         if (allocated(self%mean)) then
            matrix(:, j) = self%mean(rows, columns(j), even)
            if (even == mixed_kernel) matrix(:, j) = matrix(:, j) + odd*self%mean(rows, columns(j), odd_kernel)
         else
            matrix(:, j) = self%kernel(abs(rows - columns(j)), even)
            if (even == mixed_kernel) matrix(:, j) = matrix(:, j) + odd*sign(1, rows - columns(j))* &
                                                     self%kernel(abs(rows - columns(j)), odd_kernel)
         end if
      end do
   end subroutine entries

   !> See mfv_compliance.
   subroutine products(self, pressure, shear, by_block)
      class(layered_type), intent(in) :: self
      real(wp), intent(in) :: pressure(:), shear(:)
      real(wp), intent(out) :: by_block(:, :)
      real(wp) :: even(size(pressure), 2)

      by_block = 0.0_wp
      call self%direct%multiply(pressure, by_block(:, block_wp), shear, by_block(:, block_ut))
      if (.not. self%has_block(block_ut)) by_block(:, block_ut) = 0.0_wp
      if (.not. any(self%has_block([block_wt, block_up]))) return
      call self%odd%multiply(pressure, by_block(:, block_wt), shear, by_block(:, block_up))
      by_block(:, [block_wt, block_up]) = -by_block(:, [block_wt, block_up])
      if (self%layers%is_oblique()) then
         call self%mixed%multiply(shear, even(:, 1), pressure, even(:, 2))
         by_block(:, block_wt) = by_block(:, block_wt) + even(:, 1)
         by_block(:, block_up) = by_block(:, block_up) + even(:, 2)
      end if
      if (.not. self%has_block(block_wt)) by_block(:, block_wt) = 0.0_wp
      if (.not. self%has_block(block_up)) by_block(:, block_up) = 0.0_wp
   end subroutine products

   !> See mfv_compliance: with all blocks of a layer that is not oblique in one product.
   subroutine displacements(self, pressure, shear, normal, tangential)
      class(layered_type), intent(in) :: self
      real(wp), intent(in) :: pressure(:), shear(:)
      real(wp), intent(out) :: normal(:), tangential(:)
      real(wp) :: by_block(size(pressure), 4)

      if (all(self%has_block) .and. .not. self%layers%is_oblique()) then
         call self%all%multiply(pressure, normal, shear, tangential)
      else
         call self%products(pressure, shear, by_block)
         normal = by_block(:, block_wp) + by_block(:, block_wt)
         tangential = by_block(:, block_ut) + by_block(:, block_up)
      end if
   end subroutine displacements

   !> See mfv_compliance.
   subroutine normal_by_shear(self, shear, normal)
      class(layered_type), intent(in) :: self
      real(wp), intent(in) :: shear(:)
      real(wp), intent(out) :: normal(:)
      real(wp), dimension(size(shear)) :: even, unused

      normal = 0.0_wp
      if (.not. self%has_block(block_wt)) return
      call self%odd%multiply_odd(-shear, normal)
      if (.not. self%layers%is_oblique()) return
      call self%mixed%multiply(shear, even, 0.0_wp*shear, unused)
      normal = normal + even
   end subroutine normal_by_shear

end module mfv_layered
