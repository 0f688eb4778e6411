!> Compliance of a solid disk or of a hole in an infinite plane under box tractions, around the contact at theta = 0. Normals
!> are vertical at every node (Cartesian components, dissertation eq. 4.22), or radial (eq. 4.21) for conforming contacts.
!>
!> theta = 0 is the top of the disk and the bottom of the hole; theta grows to the right in both. With c, s = cos, sin(theta)
!>
!>     disk: sigma_rr = -p c + tau s, sigma_rtheta = p s + tau c, w = -u_r c + u_theta s, u = u_r s + u_theta c
!>     hole: sigma_rr = -p c - tau s, sigma_rtheta = p s - tau c, w =  u_r c - u_theta s, u = u_r s + u_theta c
!>
!> (eq. 4.22 is the disk's; the outward normal of the hole's surface has the opposite direction). A disk under a net force is
!> held by a force at its centre, a hole at infinity; both displacement fields contain a free rigid translation. It is chosen
!> as for the half-plane: near theta = 0 a concentrated force leaves (kappa+1)/(4 pi G) ln(D/distance) with the `datum` D, in
!> w under a normal and in u under a tangential force. As R grows, disk and hole tend to the half-plane, including the
!> constant.
!>
!> With radial normals a translation contributes to all four blocks, and so do displacements in the direction of the inclined
!> normals: neither can be removed from the coupling blocks alone. Without coupling (or with Goodman's) these lack only the
!> terms proportional to kappa - 1, the coupling of dissimilar materials, which contains no translation (docs/theory.md).
module mfv_circle
   use mfv_circle_kernels
   use mfv_compliance
   use mfv_kernel_compliance, only: kernel_compliance_type
   use mfv_kinds, only: pi, wp
   use mfv_material, only: material_type
   use mfv_toeplitz, only: toeplitz_type, new_toeplitz
   implicit none
   private
   public :: circle_type, new_circle, kernel_exact, kernel_fourier, circle_intervals

   !> Evaluation of the kernels, in the order of the key &body kernel: in closed form, or as a truncated Fourier series.
   integer, parameter :: kernel_exact = 1, kernel_fourier = 2
   !> Harmonics per interval of the circle by default (dissertation section 4.2.2.1).
   integer, parameter :: default_harmonics = 4
   integer, parameter :: by_normal = 1, by_shear = 2
   !> The kernels of unequal intervals.
   integer, parameter :: radial_kernel = 1, cross_by_normal = 2, tangential_kernel = 3, cross_by_shear = 4

   type, extends(kernel_compliance_type) :: circle_type
      private
      !> body_disk or body_hole, see mfv_circle_kernels.
      integer :: body = body_disk
      !> 1 for a disk, -1 for a hole.
      real(wp) :: side = 1.0_wp
      type(material_type) :: material
      real(wp) :: radius = 1.0_wp, datum = 1.0_wp, middle = 0.0_wp
      integer :: kernel = kernel_exact, harmonics = 0
      type(circle_kernels_type) :: kernels
      !> Whether normals are radial.
      logical :: radial = .false.
      !> cos and sin of the angle from the radius to the normal, and from the normal to the vertical, at the nodes.
      real(wp), allocatable :: cosine(:), sine(:), lean_cosine(:), lean_sine(:)
      !> The required cross kernels, from distance 0 on, and products with the kernels: by normal and by shear traction
      !> (by_normal, by_shear).
      real(wp), allocatable :: cross(:, :)
      type(toeplitz_type) :: operator(2)
      !> Rigid translation by a unit traction on an interval: of w by pressure, of u by shear.
      real(wp) :: normal_translation = 0.0_wp, tangential_translation = 0.0_wp
   contains
      procedure :: resize
      procedure :: kernels_at
      procedure :: entries
      procedure :: products
      procedure :: signature
   end type circle_type

contains

   !> Disk (`body_disk`) or hole (`body_hole`) of the radius `radius` (length) with `nodes` intervals of the arc length
   !> `interval`, symmetric about theta = 0 unless `middle` is given. `kernel`: kernel_exact or kernel_fourier; `harmonics` of
   !> the latter, 0 for four per interval; the circle must then consist of whole intervals (circle_intervals). `datum`, length:
   !> see above. `coupling`, `tangential`: see mfv_compliance. `radial`: radial normals. With nodes at common angles on circles
   !> of different radii, `radius` and `interval` are those of the arc to which tractions refer, and `datum` is in proportion:
   !> forces at an angle displace circles of any radius equally, except for ln(D/R). `ends`: of unequal intervals, of which
   !> `interval` is the mean, arc lengths, shape (nodes + 1); such a body has the exact kernel, and entries only. `middle`: arc
   !> length of the middle of equal intervals with radial normals; 0 if absent.
   function new_circle(body, material, radius, nodes, interval, datum, kernel, harmonics, coupling, tangential, radial, ends, &
                       middle) result(self)
      integer, intent(in) :: body, nodes, kernel, harmonics, coupling
      type(material_type), intent(in) :: material
      real(wp), intent(in) :: radius, interval, datum
      logical, intent(in) :: tangential
      logical, intent(in), optional :: radial
      real(wp), intent(in), optional :: ends(:), middle
      type(circle_type) :: self
      integer :: i

      self%body = body
      if (body == body_hole) self%side = -1.0_wp
      self%material = material
      self%radius = radius
      self%interval = interval
      self%datum = datum
      self%kernel = kernel
      self%harmonics = harmonics
      if (present(radial)) self%radial = radial
      if (present(middle)) self%middle = middle
      if (harmonics == 0) self%harmonics = default_harmonics*circle_intervals(radius, interval)
      self%modulus = material%plane_modulus()
      call self%choose_blocks(coupling, tangential, self%radial)
      call set_translations(self)
      if (present(ends)) then
         self%nodes = nodes
         call self%grade(ends, odd=[.false., .true., .false., .true.])
         call set_angles(self, [(0.5_wp*(ends(i) + ends(i + 1))/radius, i=1, nodes)])
      else
         call self%resize(nodes)
      end if
   end function new_circle

   !> Number of intervals of the arc length `interval` on the circle, rounded; at most 4e8, so that the harmonics are an
   !> integer too.
   pure integer function circle_intervals(radius, interval)
      real(wp), intent(in) :: radius, interval

      circle_intervals = nint(min(2.0_wp*pi*radius/interval, 4.0e8_wp))
   end function circle_intervals

   !> Translations that put displacements to zero at the datum (docs/theory.md).
   subroutine set_translations(self)
      class(circle_type), intent(inout) :: self
      real(wp) :: by_force, kappa

      kappa = self%material%kolosov
      by_force = self%interval/(4.0_wp*pi*self%material%shear_modulus)
      self%normal_translation = by_force*(kappa + 1.0_wp)*log(self%datum/self%radius)
      self%tangential_translation = self%normal_translation
      if (self%body /= body_disk) return
      self%normal_translation = self%normal_translation &
                                + by_force*(kappa**2 + 6.0_wp*kappa + 1.0_wp)/(2.0_wp*(kappa + 1.0_wp))
      self%tangential_translation = self%tangential_translation + by_force*(kappa**2 - 3.0_wp)/(kappa + 1.0_wp)
      ! With radial normals the contact can be anywhere: a force in any direction moves the disk as far.
      if (self%radial) self%tangential_translation = self%tangential_translation + by_force*0.5_wp*(7.0_wp - kappa)
   end subroutine set_translations

   !> See mfv_compliance.
   subroutine resize(self, nodes)
      class(circle_type), intent(inout) :: self
      integer, intent(in) :: nodes
      integer :: i

      self%nodes = nodes
      if (self%kernel == kernel_fourier) then
         self%kernels = fourier_kernels(self%body, self%material%kolosov, circle_intervals(self%radius, self%interval), &
                                        self%harmonics, nodes)
      else
         self%kernels = exact_kernels(self%body, self%material%kolosov, self%interval/self%radius, nodes)
      end if
      self%kernels%tangential = self%kernels%tangential + rotation_of_disk(self, self%interval)
      call set_cross(self)
      self%operator(by_normal) = new_toeplitz(self%kernels%radial, self%cross(:, by_normal), self%kernels%tangential)
      self%operator(by_shear) = self%operator(by_normal)
      if (self%radial .and. self%one_way()) &
         self%operator(by_shear) = new_toeplitz(self%kernels%radial, self%cross(:, by_shear), self%kernels%tangential)
      call set_angles(self, [((self%middle + 0.5_wp*(2*i - nodes - 1)*self%interval)/self%radius, i=1, nodes)])
      self%block_values = 3*nodes
   end subroutine resize

   !> The directions of the normals at the nodes, from their angles.
   pure subroutine set_angles(self, angle)
      class(circle_type), intent(inout) :: self
      real(wp), intent(in) :: angle(:)

      self%cosine = merge(1.0_wp, cos(angle), self%radial)
      self%sine = merge(0.0_wp, sin(angle), self%radial)
      self%lean_cosine = merge(cos(angle), 1.0_wp, self%radial)
      self%lean_sine = merge(sin(angle), 0.0_wp, self%radial)
   end subroutine set_angles

   !> See mfv_kernel_compliance: the polar kernels times G/R, and the cross kernel by shear, which can lack terms (set_cross).
   pure subroutine kernels_at(self, distance, width, kernels)
      class(circle_type), intent(in) :: self
      real(wp), intent(in) :: distance, width
      real(wp), intent(out) :: kernels(:)
      real(wp) :: dissimilar
      integer, parameter :: cross(2) = [cross_by_normal, cross_by_shear]

      call exact_values(self%body, self%material%kolosov, abs(distance)/self%radius, width/self%radius, &
                        kernels(radial_kernel), kernels(cross_by_normal), kernels(tangential_kernel))
      kernels(tangential_kernel) = kernels(tangential_kernel) + rotation_of_disk(self, width)
      kernels(cross_by_shear) = kernels(cross_by_normal)
      if (self%radial .and. .not. self%elastic_block(block_wt)) then
         dissimilar = exact_cross_of_dissimilar(self%material%kolosov, abs(distance)/self%radius, width/self%radius)
         kernels(cross_by_shear) = kernels(cross_by_shear) - dissimilar
         if (.not. self%elastic_block(block_up)) kernels(cross_by_normal) = kernels(cross_by_shear)
      end if
      kernels(cross) = sign(1.0_wp, distance)*kernels(cross)
   end subroutine kernels_at

   !> Rotation of a disk with radial normals, times G, by a unit shear traction on an interval of the length `width`, that holds
   !> the circle of half its area: the moment at its centre turns that by an infinite angle. Uniform shear then displaces the
   !> rims of disk and hole alike, each along its traction. (Without it they move together, so that nothing resists such a shear
   !> all around.)
   pure real(wp) function rotation_of_disk(self, width)
      class(circle_type), intent(in) :: self
      real(wp), intent(in) :: width

      rotation_of_disk = merge(width/(2.0_wp*pi*self%radius), 0.0_wp, self%radial .and. self%body == body_disk)
   end function rotation_of_disk

   !> The cross kernels by normal and by shear traction.
   subroutine set_cross(self)
      class(circle_type), intent(inout) :: self
      real(wp) :: dissimilar(self%nodes)
      integer :: i

      if (allocated(self%cross)) deallocate (self%cross)
      allocate (self%cross(0:self%nodes - 1, 2))
      self%cross = spread(self%kernels%cross, 2, 2)
      if (.not. self%radial .or. self%elastic_block(block_wt)) return
      if (self%kernel == kernel_fourier) then
         dissimilar = fourier_cross_of_dissimilar(self%material%kolosov, circle_intervals(self%radius, self%interval), &
                                                  self%harmonics, self%nodes)
      else
         dissimilar = exact_cross_of_dissimilar(self%material%kolosov, &
                                                [(i*(self%interval/self%radius), i=0, self%nodes - 1)], &
                                                self%interval/self%radius)
      end if
      self%cross(:, by_shear) = self%cross(:, by_shear) - dissimilar
      if (.not. self%elastic_block(block_up)) self%cross(:, by_normal) = self%cross(:, by_shear)
   end subroutine set_cross

   !> Radial and shear traction at unit pressure (`normal`) or unit shear on interval `j`.
   pure subroutine polar_traction(self, normal, j, radial, shear)
      class(circle_type), intent(in) :: self
      logical, intent(in) :: normal
      integer, intent(in) :: j
      real(wp), intent(out) :: radial, shear

      if (normal) then
         radial = -self%cosine(j)
         shear = self%sine(j)
      else
         radial = self%side*self%sine(j)
         shear = self%side*self%cosine(j)
      end if
   end subroutine polar_traction

   !> w (`normal`) or u of node i from its radial and circumferential displacements.
   elemental real(wp) function cartesian(side, normal, radial, circumferential, cosine, sine)
      real(wp), intent(in) :: side, radial, circumferential, cosine, sine
      logical, intent(in) :: normal

      if (normal) then
         cartesian = side*(circumferential*sine - radial*cosine)
      else
         cartesian = radial*sine + circumferential*cosine
      end if
   end function cartesian

   !> Normal (`normal`) or tangential component at node i of a unit translation, down and to the right.
   pure function components(self, normal, i)
      class(circle_type), intent(in) :: self
      logical, intent(in) :: normal
      integer, intent(in) :: i
      real(wp) :: components(2)

      if (normal) then
         components = [self%lean_cosine(i), -self%side*self%lean_sine(i)]
      else
         components = [self%side*self%lean_sine(i), self%lean_cosine(i)]
      end if
   end function components

   !> See mfv_compliance.
   pure subroutine entries(self, block, rows, columns, matrix)
      class(circle_type), intent(in) :: self
      integer, intent(in) :: block, rows(:), columns(:)
      real(wp), intent(out) :: matrix(:, :)
      real(wp) :: radial, shear, outward, cross, around, scale, translation(2), row_components(2, size(rows))
      logical :: normal_row, normal_column
      integer :: column, i, j

      normal_row = block == block_wp .or. block == block_wt
      normal_column = block == block_wp .or. block == block_up
      scale = self%radius/self%material%shear_modulus
      do i = 1, size(rows)
         row_components(:, i) = components(self, normal_row, rows(i))
      end do
      column = merge(by_normal, by_shear, normal_column)
      do j = 1, size(columns)
         call polar_traction(self, normal_column, columns(j), radial, shear)
         translation = [self%normal_translation, self%tangential_translation]*components(self, normal_column, columns(j))
         if (allocated(self%width)) translation = translation*(self%width(columns(j))/self%interval)
         do i = 1, size(rows)
            call polar_kernels(self, rows(i), columns(j), column, outward, cross, around)
            matrix(i, j) = scale*cartesian(self%side, normal_row, outward*radial - cross*shear, cross*radial + around*shear, &
                                           self%cosine(rows(i)), self%sine(rows(i))) &
                           + dot_product(row_components(:, i), translation)
         end do
      end do
   end subroutine entries

   !> Displacements times G/R at node `i` by unit polar tractions on interval `j`: u_r by sigma_rr, u_theta by sigma_rr (by normal
   !> or by shear traction, `column`) and u_theta by sigma_rtheta.
   pure subroutine polar_kernels(self, i, j, column, outward, cross, around)
      class(circle_type), intent(in) :: self
      integer, intent(in) :: i, j, column
      real(wp), intent(out) :: outward, cross, around
      integer :: distance

      if (allocated(self%mean)) then
         outward = self%mean(i, j, radial_kernel)
         cross = self%mean(i, j, merge(cross_by_normal, cross_by_shear, column == by_normal))
         around = self%mean(i, j, tangential_kernel)
      else
         distance = abs(i - j)
         outward = self%kernels%radial(distance)
         cross = merge(1.0_wp, -1.0_wp, i >= j)*self%cross(distance, column)
         around = self%kernels%tangential(distance)
      end if
   end subroutine polar_kernels

   !> See mfv_compliance: tractions are rotated to polar components, multiplied by the Toeplitz kernels, and displacements
   !> rotated back.
   subroutine products(self, pressure, shear, by_block)
      class(circle_type), intent(in) :: self
      real(wp), intent(in) :: pressure(:), shear(:)
      real(wp), intent(out) :: by_block(:, :)

      by_block = 0.0_wp
      call multiply(self, .true., pressure, by_block(:, block_wp), by_block(:, block_up))
      if (self%has_block(block_ut)) call multiply(self, .false., shear, by_block(:, block_wt), by_block(:, block_ut))
      if (.not. self%has_block(block_wt)) by_block(:, block_wt) = 0.0_wp
      if (.not. self%has_block(block_up)) by_block(:, block_up) = 0.0_wp
   end subroutine products

   !> w and u by a normal (`by_pressure`) or a shear traction, shapes (nodes).
   subroutine multiply(self, by_pressure, traction, normal, tangential)
      class(circle_type), intent(in) :: self
      logical, intent(in) :: by_pressure
      real(wp), intent(in) :: traction(:)
      real(wp), intent(out) :: normal(:), tangential(:)
      real(wp), dimension(size(traction)) :: radial, shear, outward, around
      real(wp) :: scale, translation(2)

      scale = self%radius/self%material%shear_modulus
      associate (c => self%cosine, s => self%sine, lean_c => self%lean_cosine, lean_s => self%lean_sine, side => self%side)
         if (by_pressure) then
            radial = -c*traction
            shear = s*traction
            translation = [dot_product(lean_c, traction), -side*dot_product(lean_s, traction)]
         else
            radial = side*s*traction
            shear = side*c*traction
            translation = [side*dot_product(lean_s, traction), dot_product(lean_c, traction)]
         end if
         translation = [self%normal_translation, self%tangential_translation]*translation
         call self%operator(merge(by_normal, by_shear, by_pressure))%multiply(radial, outward, shear, around)
         normal = scale*side*(around*s - outward*c) + lean_c*translation(1) - side*lean_s*translation(2)
         tangential = scale*(outward*s + around*c) + side*lean_s*translation(1) + lean_c*translation(2)
      end associate
   end subroutine multiply

   !> See mfv_compliance.
   pure function signature(self)
      class(circle_type), intent(in) :: self
      real(wp) :: signature(4)

      signature = [1.0_wp + self%body, self%radius, self%material%kolosov, self%material%shear_modulus]
   end function signature

end module mfv_circle
