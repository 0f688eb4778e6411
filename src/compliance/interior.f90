!> Stresses inside a body of a scene, under the tractions on its surface: coordinates, signs, invariants and the place of
!> the largest von Mises stress.
!>
!> x to the right and y up from the pole; the upper body is the mirror image of a lower one with the shear reversed.
module mfv_interior
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite, ieee_is_nan, ieee_quiet_nan, ieee_value
   use mfv_body, only: body_type, shape_disk, shape_hole, shape_matrix
   use mfv_interior_circle, only: circle_stress
   use mfv_interior_half_plane, only: half_plane_stress
   use mfv_kinds, only: wp
   use mfv_material, only: plane_strain
   use mfv_minimum, only: minimum_near, objective_type
   implicit none
   private
   public :: interior_type, new_interior, largest_type, von_mises_stress, principal_stresses, polar_stress
   public :: stress_xx, stress_yy, stress_xy, stress_zz, stress_count, stress_names, stress_von_mises

   !> Places of the stresses in what `stress` returns.
   integer, parameter :: stress_xx = 1, stress_yy = 2, stress_xy = 3, stress_zz = 4
   !> What `all_stresses` returns: those, principal stresses in the plane, von Mises, polar ones about a circle's centre.
   integer, parameter :: stress_von_mises = 7, stress_count = 10
   character(*), parameter :: stress_names = 'sigma_xx sigma_yy sigma_xy sigma_zz principal_1 principal_2 von_mises '// &
                              'sigma_rr sigma_thetatheta sigma_rtheta'

   !> A body under tractions.
   type :: interior_type
      private
      type(body_type) :: body
      !> 1 for a lower body, -1 for an upper one.
      real(wp) :: side = 1.0_wp
      !> 1 for a disk, -1 for a hole: which way out of the body the centre's radius goes.
      real(wp) :: outward = 1.0_wp
      !> Poisson's ratio in plane strain, 0 in plane stress: sigma_zz over sigma_xx + sigma_yy.
      real(wp) :: out_of_plane = 0.0_wp
      !> Boxes: positions and half-widths along the surface, tractions on the body as if it were below.
      real(wp), allocatable :: arc(:), half(:), pressure(:), shear(:)
      !> The same for a circle: angles, polar tractions.
      real(wp), allocatable :: theta(:), half_angle(:), radial(:), around(:)
   contains
      procedure :: stress
      procedure :: all_stresses
      procedure :: half_width
      procedure :: surface
      procedure :: middle
      procedure :: largest_pressure
      procedure :: contains_point
      procedure :: is_circle
      procedure :: centre
      procedure :: largest_von_mises
      procedure, private :: at_depth
   end type interior_type

   type, extends(objective_type) :: search_type
      type(interior_type) :: interior
      real(wp) :: shallowest = 0.0_wp, deepest = 0.0_wp
   contains
      procedure :: value => negative_von_mises
   end type search_type

   !> The largest von Mises stress, force/length^2, and where it is: x and y, length.
   type :: largest_type
      real(wp) :: value = 0.0_wp, x = 0.0_wp, y = 0.0_wp
   end type largest_type

contains

   !> Whether stresses inside a body can be had: it is elastic and no mere matrix.
   pure logical function has_interior(body)
      type(body_type), intent(in) :: body

      has_interior = .not. body%rigid .and. body%shape /= shape_matrix
   end function has_interior

   !> The body under `pressure` and `shear` (on the lower body, force/length^2) on boxes around the arc lengths `arc` of
   !> the widths `width`, lengths; shapes (boxes). `upper`: whether it is the body above. `plane`: see mfv_material.
   !> `radial`: whether the pressure is along the radius of a disk or hole, not vertical.
   !> `available`: false for a body that is rigid or a mere matrix.
   subroutine new_interior(body, upper, plane, radial, arc, width, pressure, shear, self, available)
      type(body_type), intent(in) :: body
      logical, intent(in) :: upper, radial
      integer, intent(in) :: plane
      real(wp), intent(in) :: arc(:), width(:), pressure(:), shear(:)
      type(interior_type), intent(out) :: self
      logical, intent(out) :: available
      logical :: loaded(size(arc))

      available = has_interior(body)
      if (.not. available) return
      self%body = body
      self%side = merge(-1.0_wp, 1.0_wp, upper)
      if (plane == plane_strain) self%out_of_plane = body%material%poisson_ratio
      loaded = abs(pressure) > 0.0_wp .or. abs(shear) > 0.0_wp
      self%arc = pack(arc, loaded)
      self%half = pack(0.5_wp*width, loaded)
      self%pressure = pack(pressure, loaded)
      self%shear = self%side*pack(shear, loaded)
      if (.not. self%is_circle()) return
      if (body%shape == shape_hole) self%outward = -1.0_wp
      self%theta = self%arc/body%radius
      self%half_angle = self%half/body%radius
      if (radial) then
         self%radial = -self%pressure
         self%around = self%outward*self%shear
      else
         self%radial = -self%pressure*cos(self%theta) + self%outward*self%shear*sin(self%theta)
         self%around = self%pressure*sin(self%theta) + self%outward*self%shear*cos(self%theta)
      end if
   end subroutine new_interior

   !> Whether the body is a disk or a hole.
   pure logical function is_circle(self)
      class(interior_type), intent(in) :: self

      is_circle = self%body%circular()
   end function is_circle

   !> y of the centre of a disk or hole (its x is 0), length.
   pure real(wp) function centre(self)
      class(interior_type), intent(in) :: self

      centre = -self%outward*self%side*self%body%radius
   end function centre

   !> Whether the point (x, y), lengths, is in the body or on its surface.
   pure logical function contains_point(self, x, y)
      class(interior_type), intent(in) :: self
      real(wp), intent(in) :: x, y
      real(wp) :: from_pole(2)
      real(wp), parameter :: round_off = 4.0_wp*epsilon(1.0_wp)

      if (self%is_circle()) then
         from_pole = radii_from_pole(self, x, y)
         associate (beyond => 2.0_wp*from_pole(1) + sum(from_pole**2))
            contains_point = merge(beyond <= round_off, beyond >= -round_off, self%body%shape == shape_disk)
         end associate
      else
         contains_point = self%side*y <= 0.0_wp
      end if
   end function contains_point

   !> Coordinates of mfv_interior_circle: outwards from the centre through the pole, and along the surface to the right.
   pure function radii_from_pole(self, x, y)
      class(interior_type), intent(in) :: self
      real(wp), intent(in) :: x, y
      real(wp) :: radii_from_pole(2)

      radii_from_pole = [self%outward*self%side*y, x]/self%body%radius
   end function radii_from_pole

   !> Stresses sigma_xx, sigma_yy, sigma_xy, sigma_zz, force/length^2, at the point (x, y), lengths; NaN outside the body
   !> and in the centre of a disk.
   function stress(self, x, y) result(values)
      class(interior_type), intent(in) :: self
      real(wp), intent(in) :: x, y
      real(wp) :: values(4), turned(3), from_pole(2)

      values = ieee_value(1.0_wp, ieee_quiet_nan)
      if (.not. (ieee_is_finite(x) .and. ieee_is_finite(y))) return
      if (.not. self%contains_point(x, y)) return
      if (self%is_circle()) then
         from_pole = radii_from_pole(self, x, y)
         if (self%body%shape == shape_disk .and. hypot(1.0_wp + from_pole(1), from_pole(2)) < epsilon(1.0_wp)) return
         turned = circle_stress(self%body%shape == shape_disk, self%body%material%kolosov, self%theta, self%half_angle, &
                                self%radial, self%around, from_pole)
         values(stress_xx) = turned(2)
         values(stress_yy) = turned(1)
         values(stress_xy) = merge(turned(3), -turned(3), self%body%shape == shape_disk)
      else
         values(:3) = half_plane_stress(self%arc, self%half, self%pressure, self%shear, x, abs(y))
      end if
      values(stress_xy) = self%side*values(stress_xy)
      values(stress_zz) = self%out_of_plane*(values(stress_xx) + values(stress_yy))
   end function stress

   !> All stresses of `stress_names` at (x, y), force/length^2; NaN outside the body, polar ones in a half-plane.
   function all_stresses(self, x, y) result(values)
      class(interior_type), intent(in) :: self
      real(wp), intent(in) :: x, y
      real(wp) :: values(stress_count)

      values = ieee_value(1.0_wp, ieee_quiet_nan)
      values(:4) = self%stress(x, y)
      if (ieee_is_nan(values(1))) return
      values(5:6) = principal_stresses(values(:4))
      values(stress_von_mises) = von_mises_stress(values(:4))
      if (self%is_circle()) values(8:10) = polar_stress(values(:4), self%centre(), x, y)
   end function all_stresses

   !> y of the surface at x, lengths; NaN beside a disk or hole.
   real(wp) function surface(self, x)
      class(interior_type), intent(in) :: self
      real(wp), intent(in) :: x
      real(wp) :: depth(1)

      surface = ieee_value(1.0_wp, ieee_quiet_nan)
      if (self%is_circle() .and. .not. self%body%covers(x)) return
      surface = 0.0_wp
      if (.not. self%is_circle()) return
      depth = self%body%recess([x], parabolic=.false.)
      surface = -self%side*depth(1)
   end function surface

   !> Half the length of surface from the first to the last loaded box, length; 0 without load.
   pure real(wp) function half_width(self)
      class(interior_type), intent(in) :: self

      half_width = 0.0_wp
      if (size(self%arc) > 0) half_width = 0.5_wp*(maxval(self%arc + self%half) - minval(self%arc - self%half))
   end function half_width

   !> Middle of the loaded surface, length.
   pure real(wp) function middle(self)
      class(interior_type), intent(in) :: self

      middle = 0.0_wp
      if (size(self%arc) > 0) middle = 0.5_wp*(maxval(self%arc + self%half) + minval(self%arc - self%half))
   end function middle

   !> Largest pressure, force/length^2.
   pure real(wp) function largest_pressure(self)
      class(interior_type), intent(in) :: self

      largest_pressure = 0.0_wp
      if (size(self%arc) > 0) largest_pressure = maxval(self%pressure)
   end function largest_pressure

   !> The largest von Mises stress: the best points of a coarse net below the contact, which is dense towards the surface,
   !> are each refined by a simplex search (GSL); on the surface itself, where box tractions are singular at the edges of
   !> boxes, values at the nodes with a parabola through the best three. Depths from 0 to less than a box are not
   !> searched: there the boxes show; nor is a disk deeper than half its radius or where stresses rise
   !> towards the force in its centre. Zero where there is no load.
   function largest_von_mises(self) result(largest)
      class(interior_type), intent(in) :: self
      type(largest_type) :: largest
      integer, parameter :: across = 81, down = 41, starts = 6
      real(wp) :: left, right, reach, shallowest, place(2), value
      real(wp), allocatable :: net(:, :), positions(:), depths(:)
      type(search_type) :: search
      integer :: best(2), i, j, start

      if (size(self%arc) == 0) return
      left = minval(self%arc - self%half)
      right = maxval(self%arc + self%half)
      reach = max(right - left, 0.0_wp)
      if (self%is_circle()) reach = min(reach, 0.5_wp*self%body%radius)
      shallowest = 2.0_wp*minval(self%half)
      positions = [(left + (right - left)*(i - 1)/(across - 1.0_wp), i=1, across)]
      depths = [(shallowest*(max(reach/shallowest, 2.0_wp))**((j - 1)/(down - 1.0_wp)), j=1, down)]
      search%interior = self
      search%shallowest = shallowest
      search%deepest = max(depths(down), shallowest)
      allocate (net(across, down))
      do j = 1, down
         do i = 1, across
            net(i, j) = self%at_depth(positions(i), depths(j))
         end do
      end do
      if (self%is_circle()) call leave_out_rise(net)
      do start = 1, starts
         best = maxloc(net)
         if (.not. net(best(1), best(2)) > 0.0_wp) exit
         place = [positions(best(1)), depths(best(2))]
         call minimum_near(search, [(right - left)/across, 0.2_wp*place(2)], place, value)
         if (place(2) < search%deepest .or. .not. self%is_circle()) &
            call keep_larger(self, largest, place(1), min(max(place(2), shallowest), search%deepest))
         call clear_around(net, best)
      end do
      call search_surface(self, largest)
   end function largest_von_mises

   !> The von Mises stress, to be made large, at an arc length and a depth.
   function negative_von_mises(self, x) result(value)
      class(search_type), intent(in) :: self
      real(wp), intent(in) :: x(:)
      real(wp) :: value

      value = -self%interior%at_depth(x(1), min(max(x(2), self%shallowest), self%deepest))
   end function negative_von_mises

   !> Take out of a net (across, down) what only rises towards its lower edge: the force in a disk's centre.
   pure subroutine leave_out_rise(net)
      real(wp), intent(inout) :: net(:, :)
      real(wp) :: below
      integer :: i, j

      do i = 1, size(net, 1)
         below = huge(1.0_wp)
         do j = size(net, 2), 1, -1
            if (net(i, j) > below) exit
            below = net(i, j)
            net(i, j) = -1.0_wp
         end do
      end do
   end subroutine leave_out_rise

   !> Take a place and its neighbours out of a net.
   pure subroutine clear_around(net, best)
      real(wp), intent(inout) :: net(:, :)
      integer, intent(in) :: best(2)
      integer, parameter :: neighbours = 4

      net(max(1, best(1) - neighbours):min(size(net, 1), best(1) + neighbours), &
          max(1, best(2) - neighbours):min(size(net, 2), best(2) + neighbours)) = -1.0_wp
   end subroutine clear_around

   !> Von Mises stress at a depth below the arc length `arc`, -1 where there is none.
   real(wp) function at_depth(self, arc, depth)
      class(interior_type), intent(in) :: self
      real(wp), intent(in) :: arc, depth
      real(wp) :: point(2), values(4)

      point = point_at(self, arc, depth)
      values = self%stress(point(1), point(2))
      at_depth = -1.0_wp
      if (ieee_is_finite(values(1))) at_depth = von_mises_stress(values)
   end function at_depth

   !> x and y at a depth below the arc length `arc`.
   pure function point_at(self, arc, depth) result(point)
      class(interior_type), intent(in) :: self
      real(wp), intent(in) :: arc, depth
      real(wp) :: point(2), angle

      point = [arc, -self%side*depth]
      if (.not. self%is_circle()) return
      angle = arc/self%body%radius
      ! The height of the arc over the pole, and the depth along the radius, each without a difference of radii.
      point(1) = (self%body%radius - self%outward*depth)*sin(angle)
      point(2) = -self%side*(depth*cos(angle) + self%outward*self%body%radius*2.0_wp*sin(0.5_wp*angle)**2)
   end function point_at

   !> The largest value at the nodes on the surface.
   subroutine search_surface(self, largest)
      class(interior_type), intent(in) :: self
      type(largest_type), intent(inout) :: largest
      real(wp) :: values(size(self%arc)), shift
      integer :: i, n

      n = size(values)
      do i = 1, n
         values(i) = self%at_depth(self%arc(i), 0.0_wp)
      end do
      i = maxloc(values, dim=1)
      if (.not. values(i) > largest%value) return
      call keep_larger(self, largest, self%arc(i), 0.0_wp)
      if (i == 1 .or. i == n) return
      associate (before => values(i - 1), here => values(i), after => values(i + 1))
         if (.not. before - 2.0_wp*here + after < 0.0_wp) return
         shift = 0.5_wp*(before - after)/(before - 2.0_wp*here + after)
         largest%value = here - 0.25_wp*(before - after)*shift
      end associate
      associate (place => point_at(self, self%arc(i) + shift*2.0_wp*self%half(i), 0.0_wp))
         largest%x = place(1)
         largest%y = place(2)
      end associate
   end subroutine search_surface

   subroutine keep_larger(self, largest, arc, depth)
      class(interior_type), intent(in) :: self
      type(largest_type), intent(inout) :: largest
      real(wp), intent(in) :: arc, depth
      real(wp) :: value, point(2)

      value = self%at_depth(arc, depth)
      if (.not. value > largest%value) return
      point = point_at(self, arc, depth)
      largest = largest_type(value, point(1), point(2))
   end subroutine keep_larger

   !> Von Mises stress of stresses as `stress` returns them.
   pure real(wp) function von_mises_stress(values)
      real(wp), intent(in) :: values(4)

      von_mises_stress = sqrt(0.5_wp*((values(stress_xx) - values(stress_yy))**2 + (values(stress_yy) - values(stress_zz))**2 &
                                      + (values(stress_zz) - values(stress_xx))**2) + 3.0_wp*values(stress_xy)**2)
   end function von_mises_stress

   !> Principal stresses in the plane, the larger first.
   pure function principal_stresses(values) result(principal)
      real(wp), intent(in) :: values(4)
      real(wp) :: principal(2), mean, radius

      mean = 0.5_wp*(values(stress_xx) + values(stress_yy))
      radius = hypot(0.5_wp*(values(stress_xx) - values(stress_yy)), values(stress_xy))
      principal = [mean + radius, mean - radius]
   end function principal_stresses

   !> sigma_rr, sigma_thetatheta and sigma_rtheta about the centre of a circle of y `centre` at the point (x, y), theta
   !> growing counterclockwise.
   pure function polar_stress(values, centre, x, y) result(polar)
      real(wp), intent(in) :: values(4), centre, x, y
      real(wp) :: polar(3), c, s, r

      r = hypot(x, y - centre)
      c = x/r
      s = (y - centre)/r
      polar(1) = c**2*values(stress_xx) + s**2*values(stress_yy) + 2.0_wp*s*c*values(stress_xy)
      polar(2) = s**2*values(stress_xx) + c**2*values(stress_yy) - 2.0_wp*s*c*values(stress_xy)
      polar(3) = s*c*(values(stress_yy) - values(stress_xx)) + (c**2 - s**2)*values(stress_xy)
   end function polar_stress

end module mfv_interior
