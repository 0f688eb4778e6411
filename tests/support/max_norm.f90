!> Maximum norm for assertions: maxval skips NaN, with which a difference from a NaN would pass as zero.
module test_max_norm
   use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
   use mfv_kinds, only: wp
   implicit none
   private
   public :: max_norm

   !> Largest absolute value of an array; the largest real number if one of its values is NaN.
   interface max_norm
      module procedure norm_of_vector, norm_of_matrix, norm_of_matrices
   end interface max_norm

contains

   pure real(wp) function norm_of_vector(values) result(norm)
      real(wp), intent(in) :: values(:)

      norm = maxval(abs(values))
      if (any(ieee_is_nan(values))) norm = huge(norm)
   end function norm_of_vector

   pure real(wp) function norm_of_matrix(values) result(norm)
      real(wp), intent(in) :: values(:, :)

      norm = norm_of_vector([values])
   end function norm_of_matrix

   pure real(wp) function norm_of_matrices(values) result(norm)
      real(wp), intent(in) :: values(:, :, :)

      norm = norm_of_vector([values])
   end function norm_of_matrices

end module test_max_norm
