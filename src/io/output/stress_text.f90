!> Texts about the stresses inside a body, for a terminal.
module mfv_stress_text
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use mfv_interior, only: stress_count, stress_names
   use mfv_kinds, only: wp
   use mfv_stress_file, only: stress_request_type, stress_result_type
   use mfv_strings, only: line_feed, to_text
   use mfv_summary, only: unit_suffix
   implicit none
   private
   public :: list_stresses, summarize_stresses

contains

   !> The stresses at every point, one per line.
   subroutine list_stresses(result, text)
      type(stress_result_type), intent(in) :: result
      character(:), allocatable, intent(out) :: text
      character(len=25*(stress_count + 2)) :: line
      integer :: i

      text = '# x y '//stress_names//line_feed
      do i = 1, size(result%x)
         write (line, '(*(es24.16e3, :, 1x))') result%x(i), result%y(i), result%stress(:, i)
         text = text//trim(line)//line_feed
      end do
   end subroutine list_stresses

   !> The largest stresses, and the group of all stresses in the file `path`. `warning`: if the yield strength is exceeded, else
   !> empty.
   subroutine summarize_stresses(path, request, result, text, warning)
      character(*), intent(in) :: path
      type(stress_request_type), intent(in) :: request
      type(stress_result_type), intent(in) :: result
      character(:), allocatable, intent(out) :: text, warning
      character(:), allocatable :: unit, largest

      unit = unit_suffix(result%stress_unit)
      if (ieee_is_finite(result%largest%value)) then
         call describe(result, result%largest%value, result%largest%x, result%largest%y, largest)
      else
         largest = 'unbounded at a sharp corner of a body'
      end if
      text = 'largest von Mises   '//largest//line_feed
      if (.not. ieee_is_finite(result%tension%value)) then
         text = text//'largest tension     singular: shear acts at a sharp corner of the body'//line_feed
      else if (result%tension%value > 0.0_wp) then
         call describe(result, result%tension%value, result%tension%x, result%tension%y, largest)
         text = text//'largest tension     '//largest//', along the surface'//line_feed
      else
         text = text//'largest tension     0'//unit//': no tension along the surface'//line_feed
      end if
      text = text//'stresses            '//to_text(stress_count)//' quantities at '//to_text(size(result%stress, 2))// &
             ' points, in '//path//' under /'//result%group//line_feed
      warning = ''
      if (.not. result%yield_strength > 0.0_wp) return
      if (ieee_is_finite(result%largest%value)) then
         if (.not. result%largest%value > result%yield_strength) return
         largest = 'largest von Mises stress, '//to_text(result%largest%value, 4)//unit
      else
         largest = 'von Mises stress, unbounded at a sharp corner'
      end if
      warning = 'warning: the '//largest//', exceeds the yield_strength '//to_text(result%yield_strength)//unit//' of the '// &
                merge('upper', 'lower', request%upper)//' body: elasticity no longer holds'
   end subroutine summarize_stresses

   !> A stress and its position, in the user's units and relative to the contact.
   subroutine describe(result, value, x, y, text)
      type(stress_result_type), intent(in) :: result
      real(wp), intent(in) :: value, x, y
      character(:), allocatable, intent(out) :: text

      text = to_text(value)//unit_suffix(result%stress_unit)//' = '//to_text(value/result%largest_pressure, 4)//' p0, '
      if (.not. ieee_is_finite(x)) then
         text = text//'far from the contact'
         return
      end if
      text = text//'at x, y = '//to_text(x)//', '//to_text(y)//unit_suffix(result%length_unit)//' = '// &
             to_text(x/result%half_width, 4)//', '//to_text(y/result%half_width, 4)//' a'
   end subroutine describe

end module mfv_stress_text
