!> The wear of a block of cycles, from the friction work of one of them.
!>
!> The depth of wear per cycle is k p s at every node, with the pressure p and the slip path s of the cycle. Over a block of N cycles
!> the pressure falls where material is removed. With the slip path of the first cycle and the pressure at the end of the block
!> (implicit Euler, stable for any N), depth h and change of pressure dp satisfy
!>
!>     h = N k s (p + dp),   h - d + C dp = 0,   force of dp = 0 or d = 0,
!>
!> where C is the compliance between the nodes in contact and d the change of the approach. The friction work per unit of surface
!> gives s (p + dp) as work (1 + dp/p). Johansson (1994, Int. J. Numer. Meth. Engng 37, 1393) integrates wear of elastic contacts in
!> this way.
module mfv_wear_block
   use mfv_compliance, only: block_wp
   use mfv_contact_path, only: contact_path_type
   use mfv_kinds, only: wp
   use mfv_lapack, only: dgesv
   use mfv_node_status, only: in_contact
   use mfv_wear, only: wear_archard
   implicit none
   private
   public :: find_wear_block

contains

   !> The number of cycles of a block, at most `remaining`, and the depth of their wear (length, shape (nodes)), from the friction
   !> work per unit of surface of its first cycle, whose end is the present state. `presses`: whether the normal force is prescribed.
   subroutine find_wear_block(path, work, remaining, presses, cycles, depth)
      type(contact_path_type), intent(in) :: path
      real(wp), intent(in) :: work(:)
      integer, intent(in) :: remaining
      logical, intent(in) :: presses
      integer, intent(out) :: cycles
      real(wp), intent(out) :: depth(:)
      integer, parameter :: most_trials = 20
      real(wp), parameter :: safety = 0.9_wp
      real(wp) :: rate(size(work)), change, fraction
      integer :: trial

      associate (wear => path%model%scene%wear, limit => path%model%kinetic_friction)
         rate = wear%coefficient*max(work, 0.0_wp)
         if (wear%law == wear_archard) rate = rate/max(limit, tiny(1.0_wp))
         if (wear%block > 0) then
            cycles = min(wear%block, remaining)
            call find_depth(path, rate, real(cycles, wp), presses, depth, change)
            return
         end if
         cycles = remaining
         do trial = 1, most_trials
            call find_depth(path, rate, real(cycles, wp), presses, depth, change)
            if (change <= wear%tolerance .or. cycles == 1) exit
            fraction = max(0.1_wp, safety*wear%tolerance/change)
            cycles = max(1, int(fraction*cycles))
         end do
      end associate
   end subroutine find_wear_block

   !> The depth of wear of `cycles` cycles at the initial rates `rate` (length per cycle), and the largest change of a pressure over
   !> the largest pressure.
   subroutine find_depth(path, rate, cycles, presses, depth, change)
      type(contact_path_type), intent(in) :: path
      real(wp), intent(in) :: rate(:), cycles
      logical, intent(in) :: presses
      real(wp), intent(out) :: depth(:), change
      real(wp), parameter :: touching = 1.0e-6_wp
      real(wp), allocatable :: matrix(:, :), right(:)
      real(wp) :: length, stress, softness
      integer, allocatable :: node(:), pivot(:)
      integer :: i, m, code

      depth = cycles*rate
      change = 0.0_wp
      associate (model => path%model, pressure => path%state%fields%pressure)
         node = pack([(i, i=1, size(rate))], in_contact(path%state%status))
         m = size(node)
         if (m == 0) return
         length = model%length()
         stress = model%compliance%modulus
         allocate (matrix(m + 1, m + 1), right(m + 1), pivot(m + 1))
         call model%compliance%entries(block_wp, node, node, matrix(:m, :m))
         matrix(:m, :m) = matrix(:m, :m)*(stress/length)
         matrix(:m, m + 1) = -model%normal_arm(node, 1)
         matrix(m + 1, :m) = model%width(node)*model%normal_arm(node, 1)/length
         matrix(m + 1, m + 1) = 0.0_wp
         if (.not. presses) then
            matrix(m + 1, :m) = 0.0_wp
            matrix(m + 1, m + 1) = 1.0_wp
         end if
         do i = 1, m
            right(i) = -depth(node(i))/length
            softness = 0.0_wp
            if (pressure(node(i)) > touching*maxval(pressure)) softness = depth(node(i))/pressure(node(i))
            matrix(i, i) = matrix(i, i) + softness*(stress/length)
         end do
         right(m + 1) = 0.0_wp
         call dgesv(m + 1, 1, matrix, m + 1, pivot, right, m + 1, code)
         if (code /= 0) return
         do i = 1, m
            if (pressure(node(i)) > touching*maxval(pressure)) &
               depth(node(i)) = depth(node(i))*max(0.0_wp, 1.0_wp + stress*right(i)/pressure(node(i)))
         end do
         change = stress*maxval(abs(right(:m)))/maxval(pressure)
      end associate
   end subroutine find_depth

end module mfv_wear_block
