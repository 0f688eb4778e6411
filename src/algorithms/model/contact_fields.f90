!> The fields of a contact state, or their rates per unit of load: tractions, surface displacements, rigid motions and
!> forces.
module mfv_contact_fields
   use mfv_kinds, only: wp
   use mfv_motions, only: motion_count, motion_shift
   implicit none
   private
   public :: contact_fields_type, new_contact_fields

   type :: contact_fields_type
      !> Pressure p >= 0 and shear traction tau on the lower body (positive to the right), force/length^2, shape (nodes).
      real(wp), allocatable :: pressure(:), shear(:)
      !> Relative displacements of the surfaces except for approach and shift, length, shape (nodes). Normal: separation, the sum
      !> of w of both bodies, each positive into the body. Tangential: u of the lower less u of the upper body, to the right. Both
      !> include the effect of the rotation of the upper body and of the bulk stresses.
      real(wp), allocatable :: normal(:), tangential(:)
      !> Motions of the upper body (mfv_motions): approach (down) and shift (right), length; rotation (counterclockwise), radians;
      !> bulk stresses of both bodies, force/length^2.
      real(wp) :: motion(motion_count) = 0.0_wp
      !> Forces of these motions, of the upper on the lower body per unit thickness: P (down) and Q (right), force/length; moment M
      !> (counterclockwise) about the centre of rotation, force; areas by which the shear tractions shorten the bodies, length^2.
      real(wp) :: force(motion_count) = 0.0_wp
   contains
      procedure :: plus
      procedure :: copy_from
      procedure :: clear
      procedure :: move
      procedure :: slip
      procedure :: padded
   end type contact_fields_type

contains

   !> Fields of an unloaded surface with `nodes` nodes.
   pure function new_contact_fields(nodes) result(fields)
      integer, intent(in) :: nodes
      type(contact_fields_type) :: fields

      allocate (fields%pressure(nodes), fields%shear(nodes), fields%normal(nodes), fields%tangential(nodes), source=0.0_wp)
   end function new_contact_fields

   !> self + step*rate.
   pure function plus(self, step, rate) result(total)
      class(contact_fields_type), intent(in) :: self
      real(wp), intent(in) :: step
      type(contact_fields_type), intent(in) :: rate
      type(contact_fields_type) :: total

      call total%copy_from(self)
      call total%move(step, rate)
   end function plus

   !> Copy `other`, reusing storage.
   pure subroutine copy_from(self, other)
      class(contact_fields_type), intent(inout) :: self
      type(contact_fields_type), intent(in) :: other

      self%pressure = other%pressure
      self%shear = other%shear
      self%normal = other%normal
      self%tangential = other%tangential
      self%motion = other%motion
      self%force = other%force
   end subroutine copy_from

   !> Set all fields to zero for `nodes` nodes, reusing storage.
   pure subroutine clear(self, nodes)
      class(contact_fields_type), intent(inout) :: self
      integer, intent(in) :: nodes

      if (allocated(self%pressure)) then
         if (size(self%pressure) == nodes) then
            self%pressure = 0.0_wp
            self%shear = 0.0_wp
            self%normal = 0.0_wp
            self%tangential = 0.0_wp
            self%motion = 0.0_wp
            self%force = 0.0_wp
            return
         end if
      end if
      call self%copy_from(new_contact_fields(nodes))
   end subroutine clear

   !> self = self + step*rate.
   pure subroutine move(self, step, rate)
      class(contact_fields_type), intent(inout) :: self
      real(wp), intent(in) :: step
      type(contact_fields_type), intent(in) :: rate

      self%pressure = self%pressure + step*rate%pressure
      self%shear = self%shear + step*rate%shear
      self%normal = self%normal + step*rate%normal
      self%tangential = self%tangential + step*rate%tangential
      self%motion = self%motion + step*rate%motion
      self%force = self%force + step*rate%force
   end subroutine move

   !> Slip s = u - U of every node, length.
   pure function slip(self)
      class(contact_fields_type), intent(in) :: self
      real(wp) :: slip(size(self%tangential))

      slip = self%tangential - self%motion(motion_shift)
   end function slip

   !> The same fields with `extra` unloaded nodes at either end; their displacements are left at zero.
   pure function padded(self, extra) result(wider)
      class(contact_fields_type), intent(in) :: self
      integer, intent(in) :: extra
      type(contact_fields_type) :: wider
      integer :: n

      n = size(self%pressure)
      wider = new_contact_fields(n + 2*extra)
      wider%pressure(extra + 1:extra + n) = self%pressure
      wider%shear(extra + 1:extra + n) = self%shear
      wider%normal(extra + 1:extra + n) = self%normal
      wider%tangential(extra + 1:extra + n) = self%tangential
      wider%motion = self%motion
      wider%force = self%force
   end function padded

end module mfv_contact_fields
