!> Stresses in layers and their base under tractions on the surface, as far as they are smooth: sums of the functions of
!> mfv_layer_stress over loads at Chebyshev points of panels, which have the same effect as the tractions on these (Lagrange
!> interpolation of the functions). Distant panels act in groups of two, four, ..., as their functions are smoother.
module mfv_interior_layers
   use mfv_chebyshev, only: chebyshev_points, lagrange_weights
   use mfv_kinds, only: wp
   use mfv_layer_stress, only: layer_stress_type, stress_row_type
   use mfv_layers, only: loads
   use mfv_quadrature, only: gauss_points
   implicit none
   private
   public :: layered_load_type, new_layered_load

   integer, parameter :: points = 24, element_points = 14

   !> Panels of one width, length.
   type :: level_type
      real(wp) :: width = 0.0_wp
      !> p + i tau times lengths, force/length, shape (points, panels).
      complex(wp), allocatable :: load(:, :)
   end type level_type

   type :: layered_load_type
      type(layer_stress_type), allocatable :: table
      real(wp) :: from = 0.0_wp, to = 0.0_wp
      !> The points of a panel from -1 to 1.
      real(wp) :: node(points) = 0.0_wp
      type(level_type), allocatable :: level(:)
   contains
      procedure :: stress
      procedure :: interface_stress
      procedure, private :: sum_over
   end type layered_load_type

contains

   !> Layers under p + i tau, force/length^2, linear from `first` to `last` in elements from `from` to `to`, lengths; shapes
   !> (elements). `table` is moved into the result.
   type(layered_load_type) function new_layered_load(table, from, to, first, last) result(self)
      type(layer_stress_type), allocatable, intent(inout) :: table
      real(wp), intent(in) :: from(:), to(:)
      complex(wp), intent(in) :: first(:), last(:)
      real(wp) :: width, place(element_points), weight(element_points)
      integer :: i, j, levels, panels

      call move_alloc(table, self%table)
      if (size(from) == 0) then
         allocate (self%level(0))
         return
      end if
      self%from = minval(from)
      self%to = maxval(to)
      ! Over the least length that the functions are smooth at any depth.
      width = self%table%scale_at(self%table%layers%layer(1)%thickness, 1)
      panels = max(ceiling((self%to - self%from)/width), 1)
      width = (self%to - self%from)/panels
      levels = 1
      do while (2**(levels - 1) < panels)
         levels = levels + 1
      end do
      allocate (self%level(levels))
      do i = 1, levels
         self%level(i)%width = width*2**(i - 1)
         allocate (self%level(i)%load(points, (panels + 2**(i - 1) - 1)/2**(i - 1)), source=(0.0_wp, 0.0_wp))
      end do
      call gauss_points(-1.0_wp, 1.0_wp, place, weight)
      do i = 1, size(from)
         call add_element(self, from(i), to(i), first(i), last(i), place, weight)
      end do
      self%node = chebyshev_points(points, -1.0_wp, 1.0_wp)
      ! From Chebyshev moments to loads at the points.
      self%level(1)%load = matmul(reshape([((merge(1.0_wp, 2.0_wp, j == 1)*cos((j - 1)*acos(self%node(i)))/points, i=1, points), &
                                            j=1, points)], [points, points]), self%level(1)%load)
      do i = 2, levels
         call join_panels(self%node, self%level(i - 1), self%level(i))
      end do
   end function new_layered_load

   !> Add an element to the Chebyshev moments of the panels of the first level. `place`, `weight`: of a quadrature on (-1, 1).
   pure subroutine add_element(self, from, to, first, last, place, weight)
      type(layered_load_type), intent(inout) :: self
      real(wp), intent(in) :: from, to, place(:), weight(:)
      complex(wp), intent(in) :: first, last
      real(wp) :: left, right, x, t, now, before, next
      complex(wp) :: here
      integer :: i, j, panel

      if (.not. to > from) return
      associate (level => self%level(1))
         panel = min(max(int((from - self%from)/level%width) + 1, 1), size(level%load, 2))
         left = from
         do
            right = to
            if (panel < size(level%load, 2)) right = min(to, self%from + panel*level%width)
            do i = 1, size(place)
               x = left + 0.5_wp*(right - left)*(1.0_wp + place(i))
               here = (first + (last - first)*((x - from)/(to - from)))*(0.5_wp*(right - left)*weight(i))
               t = 2.0_wp*(x - self%from)/level%width - (2*panel - 1)
               before = t
               now = 1.0_wp
               do j = 1, points
                  level%load(j, panel) = level%load(j, panel) + here*now
                  next = 2.0_wp*t*now - before
                  before = now
                  now = next
               end do
            end do
            if (.not. right < to) exit
            left = right
            panel = panel + 1
         end do
      end associate
   end subroutine add_element

   !> Loads of panels of twice the width.
   pure subroutine join_panels(node, narrow, wide)
      real(wp), intent(in) :: node(:)
      type(level_type), intent(in) :: narrow
      type(level_type), intent(inout) :: wide
      real(wp) :: weight(points, points, 2)
      integer :: j, panel

      weight = reshape([((lagrange_weights(points, 0.5_wp*(node(j) + 2*panel - 3)), j=1, points), panel=1, 2)], shape(weight))
      do panel = 1, size(narrow%load, 2)
         associate (load => wide%load(:, (panel + 1)/2))
            load = load + matmul(weight(:, :, 2 - modulo(panel, 2)), narrow%load(:, panel))
         end associate
      end do
   end subroutine join_panels

   !> Stresses (sigma_xx, sigma_yy, sigma_xy), force/length^2, at a depth in a layer below the surface point x, lengths: in the
   !> first layer those that an endless one does not have.
   pure function stress(self, x, depth, layer)
      class(layered_load_type), intent(in) :: self
      real(wp), intent(in) :: x, depth
      integer, intent(in) :: layer
      real(wp) :: stress(3)

      stress = 0.0_wp
      if (size(self%level) == 0) return
      stress = self%sum_over(self%table%row(depth, layer, max(abs(x - self%from), abs(x - self%to))), x)
   end function stress

   !> The same at the upper side of the interface below a layer; 0: at the surface.
   pure function interface_stress(self, x, layer) result(stress)
      class(layered_load_type), intent(in) :: self
      real(wp), intent(in) :: x
      integer, intent(in) :: layer
      real(wp) :: stress(3)

      stress = 0.0_wp
      if (size(self%level) == 0) return
      if (max(abs(x - self%from), abs(x - self%to)) > self%table%reach) then
         stress = self%stress(x, self%table%layers%depth_of(layer), max(layer, 1))
      else
         stress = self%sum_over(self%table%interface(layer), x)
      end if
   end function interface_stress

   !> The sum over all panels.
   pure function sum_over(self, row, x) result(stress)
      class(layered_load_type), intent(in) :: self
      type(stress_row_type), intent(in) :: row
      real(wp), intent(in) :: x
      real(wp) :: stress(3)
      integer :: panel

      stress = 0.0_wp
      do panel = 1, size(self%level(size(self%level))%load, 2)
         call add_panel(self, row, x, size(self%level), panel, stress)
      end do
   end function sum_over

   !> Add a panel of a level, or the two that it consists of.
   recursive pure subroutine add_panel(self, row, x, number, panel, stress)
      class(layered_load_type), intent(in) :: self
      type(stress_row_type), intent(in) :: row
      real(wp), intent(in) :: x
      integer, intent(in) :: number, panel
      real(wp), intent(inout) :: stress(3)
      real(wp) :: away, by_load(3, loads)
      integer :: j

      associate (level => self%level(number))
         away = x - self%from - (panel - 0.5_wp)*level%width
         if (row%period > 0.0_wp) away = away - row%period*anint(away/row%period)
         if (number > 1 .and. (abs(away) - self%table%layers%slant()*row%scale < 1.5_wp*level%width .or. &
                               (row%period > 0.0_wp .and. 4.0_wp*level%width > row%period))) then
            do j = 2*panel - 1, min(2*panel, size(self%level(number - 1)%load, 2))
               call add_panel(self, row, x, number - 1, j, stress)
            end do
            return
         end if
         do j = 1, points
            by_load = row%at(away - 0.5_wp*level%width*self%node(j))
            stress = stress + by_load(:, 1)*real(level%load(j, panel), wp) + by_load(:, 2)*aimag(level%load(j, panel))
         end do
      end associate
   end subroutine add_panel

end module mfv_interior_layers
