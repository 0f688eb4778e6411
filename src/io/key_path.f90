!> Names of keys with their groups: `friction%mu`, `body(2)%radius`.
module mfv_key_path
   use mfv_strings, only: lower_case, quoted
   implicit none
   private
   public :: split_key

contains

   !> Group, number of the group (1 unless written), and key, in lower case. `written_number`: as it is written, with its brackets;
   !> empty for none. `why`: what is wrong with the name, empty where nothing is.
   subroutine split_key(written, group, written_number, number, key, why)
      character(*), intent(in) :: written
      character(:), allocatable, intent(out) :: group, written_number, key, why
      integer, intent(out) :: number
      character(:), allocatable :: text
      integer :: percent, bracket, code, last

      why = ''
      number = 1
      written_number = ''
      group = ''
      text = lower_case(written)
      percent = index(text, '%')
      if (percent == 0) then
         key = text
         why = quoted(written)//": must be 'group%key', 'group(number)%key'"
         return
      end if
      key = text(percent + 1:)
      group = text(:percent - 1)
      bracket = index(group, '(')
      if (bracket == 0) return
      written_number = group(bracket:)
      group = group(:bracket - 1)
      code = 1
      last = len(written_number)
      if (last > 2 .and. last < 12) then
         if (written_number(last:) == ')' .and. verify(written_number(2:last - 1), '0123456789') == 0) &
            read (written_number(2:last - 1), *, iostat=code) number
      end if
      if (code /= 0) why = quoted(written)//": '"//written_number//"' is no number of a group, such as (2)"
   end subroutine split_key

end module mfv_key_path
