!> Stresses inside a body of a scene under its surface tractions and, in a half-plane, a uniform bulk stress: coordinates, signs
!> and invariants. Tractions are continuous between nodes, see mfv_surface_tractions. x to the right and y up from the initial point
!> of contact; the upper body is the mirror image of a lower one with the shear reversed.
module mfv_interior
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite, ieee_is_nan, ieee_quiet_nan, ieee_value
   use mfv_body, only: body_type
   use mfv_interior_circle, only: circle_load_type, longest_element, new_circle_load
   use mfv_interior_layers, only: layered_load_type, new_layered_load
   use mfv_interior_half_plane, only: half_plane_load_type, new_half_plane_load, surface_stress_of
   use mfv_kinds, only: wp
   use mfv_material, only: material_type
   use mfv_surface_tractions, only: find_closed_elements, find_traction_elements, traction_elements_type, zone_list_type
   use mfv_tolerances, only: certified, significant
   implicit none
   private
   public :: interior_type, new_interior, has_interior, von_mises_stress, tresca_stress, polar_stress
   public :: stress_xx, stress_yy, stress_xy, stress_count, stress_names

   !> Indices of the result of `stress`.
   integer, parameter :: stress_xx = 1, stress_yy = 2, stress_xy = 3, stress_zz = 4
   !> Result of `all_stresses`: these, principal stresses in the plane, von Mises, polar stresses about a circle's centre,
   !> Tresca, direction of the first principal stress.
   integer, parameter :: stress_von_mises = 7, stress_tresca = 11, stress_angle = 12, stress_count = 12
   character(*), parameter :: stress_names = 'sigma_xx sigma_yy sigma_xy sigma_zz principal_1 principal_2 von_mises '// &
                              'sigma_rr sigma_thetatheta sigma_rtheta tresca principal_angle'

   !> A body under tractions.
   type :: interior_type
      type(body_type) :: body
      !> 1 for a lower body, -1 for an upper one.
      real(wp) :: side = 1.0_wp
      !> 1 for a disk, -1 for a hole: sign of the outward radial direction.
      real(wp) :: outward = 1.0_wp
      !> Elements of the surface, their ends as arc lengths and over `length`, and p + i tau on the body as if it were the
      !> lower one.
      type(traction_elements_type) :: elements
      !> A circle or a half-plane with these elements.
      type(circle_load_type) :: circle
      type(half_plane_load_type) :: half_plane
      !> Layers: what a half-plane of the first one does not have.
      type(layered_load_type) :: layers
      !> Largest pressure at the nodes, force/length^2; unit of the elements of a half-plane, length.
      real(wp) :: peak = 0.0_wp, length = 1.0_wp
      !> Bulk stress of a half-plane, of layers that of their base: a uniform sigma_xx, force/length^2.
      real(wp) :: bulk = 0.0_wp
      !> Intervals about corners (mfv_corners) where tractions are not resolved, arc lengths, shape (2, corners).
      real(wp), allocatable :: unresolved(:, :)
   contains
      procedure :: stress
      procedure :: all_stresses
      procedure :: surface_stress
      procedure :: surface_von_mises
      procedure :: zones
      procedure :: remote_stress
      procedure :: bulk_of
      procedure :: prepare
      procedure :: interface_tractions
      procedure :: weight_at
      procedure :: half_width
      procedure :: surface
      procedure :: middle
      procedure :: centre
      procedure :: kinks
      procedure :: knots_apart
      procedure :: knots
      procedure :: point_at
      procedure :: is_sheared
      procedure :: is_unresolved
      procedure :: zone_edges
   end type interior_type

contains

   !> Whether stresses inside a body are available: it is elastic and not a matrix.
   pure logical function has_interior(body)
      type(body_type), intent(in) :: body

      has_interior = .not. (body%rigid .or. body%is_matrix())
   end function has_interior

   !> The body under `pressure` and `shear` (on the lower body, force/length^2) at nodes with the arc lengths `arc` and the
   !> intervals `width`, lengths; shapes (nodes). `zones`: known edges of contact and stick zones. `upper`: the upper body.
   !> `radial`: pressure along the radius of a disk or hole, not vertical. `available`: false for a
   !> rigid body or a matrix.
   subroutine new_interior(body, upper, radial, arc, width, pressure, shear, zones, self, available)
      type(body_type), intent(in) :: body
      logical, intent(in) :: upper, radial
      real(wp), intent(in) :: arc(:), width(:), pressure(:), shear(:)
      type(zone_list_type), intent(in) :: zones
      type(interior_type), intent(out) :: self
      logical, intent(out) :: available
      type(zone_list_type) :: seen
      real(wp) :: longest

      available = has_interior(body)
      if (.not. available) return
      self%body = body
      ! That of a scene without a model.
      if (.not. allocated(self%body%elasticity%layer_stress)) &
         call self%body%elasticity%find_surface_stress(arc(size(arc)) - arc(1) + width(1))
      self%side = merge(-1.0_wp, 1.0_wp, upper)
      if (body%is_hole()) self%outward = -1.0_wp
      self%peak = maxval(pressure)
      longest = huge(1.0_wp)
      if (self%body%deforms_as_circle()) longest = longest_element*body%radius
      seen = zones
      if (upper) seen%pair = zones%pair%with_reversed_shear()
      if (radial) seen%turn = self%outward/body%radius
      if (zones%closed) then
         call find_closed_elements(arc, width, pressure, self%side*shear, seen%turn, longest, self%elements)
      else
         call find_traction_elements(arc, width, pressure, self%side*shear, seen, longest, self%elements)
         if (zones%period > 0.0_wp) call join_ends(self%elements, zones%period)
      end if
      associate (e => self%elements)
         if (self%body%deforms_as_circle()) then
            self%length = body%radius
         else if (size(e%from) > 0) then
            self%length = 0.5_wp*(maxval(e%to) - minval(e%from))
         end if
         e%from = e%from/self%length
         e%to = e%to/self%length
         if (self%body%deforms_as_circle()) then
            self%circle = new_circle_load(body%is_disk(), body%elasticity%material%kolosov, e%from, e%to, &
                                          polar(self, radial, e%from, e%first), polar(self, radial, e%to, e%last))
         else
            self%half_plane = new_half_plane_load(body%elasticity%material, e%from, e%to, e%first, e%last, &
                                                  body%elasticity%period/self%length, zones%middle/self%length)
            if (body%elasticity%is_layered()) self%layers = &
               new_layered_load(self%body%elasticity%layer_stress, self%length*e%from, self%length*e%to, e%first, e%last)
         end if
      end associate
   end subroutine new_interior

   !> Let tractions that meet at the ends of a period be continuous there, which were found from the nodes to one side each.
   pure subroutine join_ends(elements, period)
      type(traction_elements_type), intent(inout) :: elements
      real(wp), intent(in) :: period
      integer :: n

      elements%sharp = .false.
      elements%singular = .false.
      n = size(elements%from)
      if (n == 0) return
      if (abs(elements%to(n) - elements%from(1) - period) > significant*period) return
      elements%first(1) = 0.5_wp*(elements%first(1) + elements%last(n))
      elements%last(n) = elements%first(1)
   end subroutine join_ends

   !> sigma_rr + i sigma_rtheta on the circle at the angle theta, from p + i tau; `radial`: see new_interior.
   elemental complex(wp) function polar(self, radial, angle, traction)
      type(interior_type), intent(in) :: self
      logical, intent(in) :: radial
      real(wp), intent(in) :: angle
      complex(wp), intent(in) :: traction

      associate (p => real(traction, wp), tau => self%outward*aimag(traction))
         if (radial) then
            polar = cmplx(-p, tau, wp)
         else
            polar = cmplx(-p*cos(angle) + tau*sin(angle), p*sin(angle) + tau*cos(angle), wp)
         end if
      end associate
   end function polar

   !> y of the centre of a disk or hole (its x is 0), length.
   pure real(wp) function centre(self)
      class(interior_type), intent(in) :: self

      centre = -self%outward*self%side*self%body%radius
   end function centre

   !> Whether the point (x, y), lengths, is in the body or on its surface.
   pure logical function contains_point(self, x, y)
      type(interior_type), intent(in) :: self
      real(wp), intent(in) :: x, y
      real(wp) :: from_origin(2)
      type(material_type) :: material
      real(wp), parameter :: tolerance = 4.0_wp*epsilon(1.0_wp)

      if (self%body%deforms_as_circle()) then
         from_origin = coordinates_in_radii(self, x, y)
         associate (beyond => 2.0_wp*from_origin(1) + sum(from_origin**2))
            contains_point = merge(beyond <= tolerance, beyond >= -tolerance, self%body%is_disk())
         end associate
      else
         material = self%body%elasticity%material_of(self%body%elasticity%layer_at(abs(y)))
         contains_point = self%side*y <= 0.0_wp .and. material%exists()
      end if
   end function contains_point

   !> Coordinates of mfv_interior_circle: from theta = 0 outwards along the radius, and tangential to the right.
   pure function coordinates_in_radii(self, x, y)
      class(interior_type), intent(in) :: self
      real(wp), intent(in) :: x, y
      real(wp) :: coordinates_in_radii(2)

      coordinates_in_radii = [self%outward*self%side*y, x]/self%body%radius
   end function coordinates_in_radii

   !> Stresses sigma_xx, sigma_yy, sigma_xy, sigma_zz, force/length^2, at the point (x, y), lengths; NaN outside the body and
   !> at the centre of a disk.
   function stress(self, x, y) result(values)
      class(interior_type), intent(in) :: self
      real(wp), intent(in) :: x, y
      real(wp) :: values(4), turned(3), from_origin(2)
      integer :: layer

      values = ieee_value(1.0_wp, ieee_quiet_nan)
      if (.not. (ieee_is_finite(x) .and. ieee_is_finite(y))) return
      if (.not. contains_point(self, x, y)) return
      layer = 1
      if (self%body%deforms_as_circle()) then
         from_origin = coordinates_in_radii(self, x, y)
         if (self%body%is_disk() .and. hypot(1.0_wp + from_origin(1), from_origin(2)) < epsilon(1.0_wp)) return
         turned = self%circle%stress(from_origin)
         values(stress_xx) = turned(2)
         values(stress_yy) = turned(1)
         values(stress_xy) = merge(turned(3), -turned(3), self%body%is_disk())
      else
         layer = self%body%elasticity%layer_at(abs(y))
         values(:3) = stress_below(self, x, abs(y), layer)
      end if
      values(stress_zz) = stress_zz_of(self, layer, values(:3))
      values(stress_xy) = self%side*values(stress_xy)
   end function stress

   !> Stresses (sigma_xx, sigma_yy, sigma_xy) of a half-plane or a layer at a depth below x, lengths, as if it were below its
   !> surface.
   function stress_below(self, x, depth, layer) result(values)
      type(interior_type), intent(in) :: self
      real(wp), intent(in) :: x, depth
      integer, intent(in) :: layer
      real(wp) :: values(3)

      values = 0.0_wp
      if (layer == 1) values = self%half_plane%stress(x/self%length, depth/self%length)
      if (self%body%elasticity%is_layered()) values = values + self%layers%stress(x, depth, layer)
      values(stress_xx) = values(stress_xx) + self%bulk_of(layer)
   end function stress_below

   !> sigma_zz in a layer, or in a body without layers, beside its stresses in the plane, force/length^2.
   pure real(wp) function stress_zz_of(self, layer, in_plane) result(stress)
      type(interior_type), intent(in) :: self
      integer, intent(in) :: layer
      real(wp), intent(in) :: in_plane(3)
      type(material_type) :: material

      material = self%body%elasticity%material_of(layer)
      stress = material%stress_out_of_plane(in_plane)
   end function stress_zz_of

   !> Bulk stress of a layer, force/length^2: all extend alike along x.
   pure real(wp) function bulk_of(self, layer) result(bulk)
      class(interior_type), intent(in) :: self
      integer, intent(in) :: layer
      type(material_type) :: material

      bulk = self%bulk
      if (.not. self%body%elasticity%is_layered() .or. .not. abs(bulk) > 0.0_wp) return
      material = self%body%elasticity%material_of(layer)
      bulk = bulk*self%body%elasticity%strain_by_bulk_stress()/material%compliance(1)
   end function bulk_of

   !> Tractions at the interface below a layer and below the arc length `arc`, force/length^2: sigma_yy, a tension positive, and
   !> sigma_xy.
   function interface_tractions(self, arc, layer) result(tractions)
      class(interior_type), intent(in) :: self
      real(wp), intent(in) :: arc
      integer, intent(in) :: layer
      real(wp) :: tractions(2), values(3)

      values = self%layers%interface_stress(arc, layer)
      if (layer == 1) values = values + self%half_plane%stress(arc/self%length, self%body%elasticity%depth_of(1)/self%length)
      tractions = [values(stress_yy), self%side*values(stress_xy)]
   end function interface_tractions

   !> Make stresses in layers quick down to the depth of the search for the largest ones, and down to the depth `deepest`, length.
   subroutine prepare(self, deepest)
      class(interior_type), intent(inout) :: self
      real(wp), intent(in), optional :: deepest
      !> Deeper ones are found one by one; over the thickness of the layers and the width of the contact.
      real(wp), parameter :: most = 50.0_wp
      real(wp) :: depth

      if (.not. self%body%elasticity%is_layered()) return
      depth = 2.0_wp*self%half_width()
      if (present(deepest)) depth = max(depth, deepest)
      call self%layers%table%prepare(min(depth, most*(self%body%elasticity%thickness() + 2.0_wp*self%half_width())))
   end subroutine prepare

   !> What a von Mises stress at a depth, length, counts in the search for the largest one: of layers with different yield strengths
   !> its ratio to that of the layer, in terms of the largest one.
   pure real(wp) function weight_at(self, depth) result(weight)
      class(interior_type), intent(in) :: self
      real(wp), intent(in) :: depth
      real(wp) :: largest
      integer :: i, layer

      weight = 1.0_wp
      if (.not. self%body%has_strength()) return
      largest = maxval([(self%body%strength_of(i), i=1, self%body%elasticity%layer_count() + 1)])
      layer = self%body%elasticity%layer_at(depth)
      weight = 0.0_wp
      if (self%body%strength_of(layer) > 0.0_wp) weight = largest/self%body%strength_of(layer)
   end function weight_at

   !> Stress tangential to the surface, force/length^2, positive in tension, at an arc length from the origin of x.
   pure real(wp) function surface_stress(self, arc)
      class(interior_type), intent(in) :: self
      real(wp), intent(in) :: arc
      real(wp) :: of_layers(3)

      if (self%body%deforms_as_circle()) then
         surface_stress = self%circle%surface_stress(arc/self%body%radius)
      else
         surface_stress = self%half_plane%surface_stress(arc/self%length) + self%bulk_of(1)
         if (.not. self%body%elasticity%is_layered()) return
         of_layers = self%layers%interface_stress(arc, 0)
         surface_stress = surface_stress + of_layers(stress_xx)
      end if
   end function surface_stress

   !> Von Mises stress at the surface, force/length^2, at an arc length from the origin of x: that of `stress` there, but quicker.
   pure real(wp) function surface_von_mises(self, arc)
      class(interior_type), intent(in) :: self
      real(wp), intent(in) :: arc
      complex(wp) :: traction
      real(wp) :: along, values(4)

      along = self%surface_stress(arc)
      if (self%body%deforms_as_circle()) then
         traction = self%circle%traction(arc/self%length)
      else
         traction = -conjg(self%half_plane%traction(arc/self%length))
      end if
      values([stress_xx, stress_yy, stress_xy]) = [along, real(traction, wp), aimag(traction)]
      values(stress_zz) = self%body%elasticity%material%stress_out_of_plane(values(:3))
      surface_von_mises = von_mises_stress(values)
   end function surface_von_mises

   !> Ends of the loaded parts of the surface, arc lengths from the origin of x, shape (2, parts).
   pure function zones(self)
      class(interior_type), intent(in) :: self
      real(wp), allocatable :: zones(:, :)
      logical :: begins(size(self%elements%from)), ends(size(self%elements%from))
      integer :: n

      n = size(begins)
      begins(:1) = .true.
      ends(n:) = .true.
      begins(2:) = self%elements%from(2:) > self%elements%to(:n - 1)
      ends(:n - 1) = begins(2:)
      associate (left => pack(self%elements%from, begins), right => pack(self%elements%to, ends))
         zones = self%length*transpose(reshape([left, right], [size(left), 2]))
      end associate
   end function zones

   !> Stresses as of `stress` far from the contact, force/length^2, in a layer.
   pure function remote_stress(self, layer) result(values)
      class(interior_type), intent(in) :: self
      integer, intent(in) :: layer
      real(wp) :: values(4)

      values = 0.0_wp
      values(stress_xx) = self%bulk_of(layer)
      values(stress_zz) = stress_zz_of(self, layer, values(:3))
   end function remote_stress

   !> All stresses of `stress_names` at (x, y), force/length^2, and the direction in radians; NaN outside the body; polar
   !> stresses NaN in a half-plane.
   function all_stresses(self, x, y) result(values)
      class(interior_type), intent(in) :: self
      real(wp), intent(in) :: x, y
      real(wp) :: values(stress_count)

      values = ieee_value(1.0_wp, ieee_quiet_nan)
      values(:4) = self%stress(x, y)
      if (ieee_is_nan(values(1))) return
      values(5:6) = principal_stresses(values(:4))
      values(stress_von_mises) = von_mises_stress(values(:4))
      values(stress_tresca) = tresca_stress(values(:4))
      ! Of the larger principal stress in the plane, counterclockwise from the x axis, in (-pi/2, pi/2].
      values(stress_angle) = 0.5_wp*atan2(2.0_wp*values(stress_xy), values(stress_xx) - values(stress_yy))
      if (self%body%deforms_as_circle()) values(8:10) = polar_stress(values(:4), self%centre(), x, y)
   end function all_stresses

   !> y of the surface at x, lengths; NaN outside a disk or hole.
   real(wp) function surface(self, x)
      class(interior_type), intent(in) :: self
      real(wp), intent(in) :: x
      real(wp) :: depth(1)

      surface = ieee_value(1.0_wp, ieee_quiet_nan)
      if (self%body%deforms_as_circle() .and. .not. self%body%covers(x, .false.)) return
      surface = 0.0_wp
      if (.not. self%body%deforms_as_circle()) return
      depth = self%body%recess([x], parabolic=.false.)
      surface = -self%side*depth(1)
   end function surface

   !> Half the arc length from the first to the last edge of the loaded zones, length; 0 without load.
   pure real(wp) function half_width(self)
      class(interior_type), intent(in) :: self

      half_width = 0.0_wp
      associate (e => self%elements)
         if (size(e%from) > 0) half_width = 0.5_wp*(maxval(e%to) - minval(e%from))*self%length
      end associate
   end function half_width

   !> Middle of the loaded surface, length.
   pure real(wp) function middle(self)
      class(interior_type), intent(in) :: self

      middle = 0.0_wp
      associate (e => self%elements)
         if (size(e%from) > 0) middle = 0.5_wp*(maxval(e%to) + minval(e%from))*self%length
      end associate
   end function middle

   !> Whether there is shear on the surface.
   pure logical function is_sheared(self)
      class(interior_type), intent(in) :: self

      is_sheared = any(max(abs(aimag(self%elements%first)), abs(aimag(self%elements%last))) > certified*self%peak)
   end function is_sheared

   !> Whether the tractions at an arc length from the origin of x are not resolved.
   pure logical function is_unresolved(self, arc)
      class(interior_type), intent(in) :: self
      real(wp), intent(in) :: arc

      is_unresolved = .false.
      if (allocated(self%unresolved)) is_unresolved = any(self%unresolved(1, :) < arc .and. arc < self%unresolved(2, :))
   end function is_unresolved

   !> Edges of contact and stick zones, arc lengths from the origin of x, ascending, with equidistant points between them,
   !> about `most_between` in total.
   function zone_edges(self, most_between) result(places)
      class(interior_type), intent(in) :: self
      integer, intent(in) :: most_between
      real(wp), allocatable :: places(:)
      integer :: i, j, number

      associate (edges => self%elements%edges)
         places = edges(:1)
         do i = 2, size(edges)
            number = ceiling(most_between*(edges(i) - edges(i - 1))/(edges(size(edges)) - edges(1)))
            places = [places, (edges(i - 1) + (edges(i) - edges(i - 1))*j/(number + 1), j=1, number), edges(i)]
         end do
      end associate
   end function zone_edges

   !> Places where the slope of the shear traction (and of the pressure where it stretches the surface) changes most, and their
   !> neighbours, arc lengths from the origin of x, ascending: edges of former zones, which are not among the edges but where the
   !> tension has cusps.
   function kinks(self) result(places)
      class(interior_type), intent(in) :: self
      real(wp), allocatable :: places(:)
      integer, parameter :: most = 12, beside = 2
      real(wp), dimension(size(self%elements%from)) :: length, slope
      real(wp) :: change(size(self%elements%from) - 1)
      logical :: is_place(size(self%elements%from))
      real(wp) :: least
      integer :: i, n, number

      n = size(length)
      allocate (places(0))
      if (n < 2) return
      associate (elements => self%elements)
         length = elements%to - elements%from
         slope = surface_stress_of(self%body%elasticity%material, 0.0_wp, 0.0_wp, real(elements%last - elements%first, wp)/length, &
                                   aimag(elements%last - elements%first)/length)
         change = 0.0_wp
         where (.not. elements%from(2:) > elements%to(:n - 1)) change = abs(slope(2:) - slope(:n - 1))*(length(2:) + length(:n - 1))
         is_place = .false.
         do number = 1, most
            ! Equal ones, as on both sides of a symmetric contact, together: the places must not depend on round-off.
            least = maxval(change)*(1.0_wp - significant)
            if (.not. least > 0.0_wp) exit
            do i = 1, n - 1
               if (change(i) < least) cycle
               is_place([max(i - beside, 1), i, min(i + beside, n - 1)]) = .true.
               change(max(i - beside, 1):min(i + beside, n - 1)) = 0.0_wp
            end do
         end do
         places = self%length*pack(elements%to, is_place)
      end associate
   end function kinks

   !> Ends of the elements with linear tractions, arc lengths from the origin of x.
   pure function knots(self)
      class(interior_type), intent(in) :: self
      real(wp), allocatable :: knots(:)
      integer :: n

      n = size(self%elements%from)
      knots = self%length*[self%elements%from, self%elements%to(n:)]
   end function knots

   !> Lengths of the elements.
   pure function knots_apart(self) result(lengths)
      class(interior_type), intent(in) :: self
      real(wp), allocatable :: lengths(:)

      lengths = self%length*(self%elements%to - self%elements%from)
   end function knots_apart

   !> x and y at a depth below the arc length `arc`.
   pure function point_at(self, arc, depth) result(point)
      class(interior_type), intent(in) :: self
      real(wp), intent(in) :: arc, depth
      real(wp) :: point(2), angle

      point = [arc, -self%side*depth]
      if (.not. self%body%deforms_as_circle()) return
      angle = arc/self%body%radius
      ! Height of the arc above y = 0 and depth along the radius, each without a difference of radii.
      point(1) = (self%body%radius - self%outward*depth)*sin(angle)
      point(2) = -self%side*(depth*cos(angle) + self%outward*self%body%radius*2.0_wp*sin(0.5_wp*angle)**2)
   end function point_at

   !> Von Mises stress of stresses as `stress` returns them.
   pure real(wp) function von_mises_stress(values)
      real(wp), intent(in) :: values(4)

      von_mises_stress = sqrt(0.5_wp*((values(stress_xx) - values(stress_yy))**2 + (values(stress_yy) - values(stress_zz))**2 &
                                      + (values(stress_zz) - values(stress_xx))**2) + 3.0_wp*values(stress_xy)**2)
   end function von_mises_stress

   !> Tresca's equivalent stress: largest difference of the three principal stresses including sigma_zz; twice the largest
   !> shear stress.
   pure real(wp) function tresca_stress(values)
      real(wp), intent(in) :: values(4)
      real(wp) :: principal(3)

      principal = [principal_stresses(values), values(stress_zz)]
      tresca_stress = maxval(principal) - minval(principal)
   end function tresca_stress

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
