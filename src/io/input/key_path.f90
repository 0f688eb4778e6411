!> Names of keys with their groups: `friction%mu`, `body(2)%radius`.
module mfv_key_path
   use mfv_keys, only: catalogue_type, suggest
   use mfv_strings, only: has_word, lower_case, quoted
   implicit none
   private
   public :: read_key_name

contains

   !> Group, number of the group (1 unless written) and key of a name, which must be in a catalogue; in lower case. `why`: what is
   !> wrong with it, empty where nothing is; whether there is a group of this number is for the caller to tell.
   subroutine read_key_name(written, catalogue, group, number, key, why)
      character(*), intent(in) :: written
      type(catalogue_type), intent(in) :: catalogue
      character(:), allocatable, intent(out) :: group, key, why
      integer, intent(out) :: number
      character(:), allocatable :: text
      integer :: percent, bracket
      logical :: repeats

      why = ''
      text = lower_case(written)
      percent = index(text, '%')
      bracket = index(text(:max(percent - 1, 0))//'(', '(')
      group = text(:bracket - 1)
      key = text(percent + 1:)
      repeats = has_word(catalogue%repeated_groups, group)
      number = 1
      if (bracket < percent) number = number_in(text(bracket:percent - 1))
      if (percent == 0) then
         why = "must be 'group%key', 'group(number)%key'"
      else if (number < 0) then
         why = quoted(text(bracket:percent - 1))//' is no number of a group, such as (2)'
      else if (.not. has_word(catalogue%group_list, group)) then
         call suggest(group, catalogue%groups(), '', why)
         why = 'unknown group'//why//'; groups are '//catalogue%group_list
      else if (catalogue%place(group, key) == 0) then
         call suggest(key, catalogue%names(group), '', why)
         why = 'unknown key of &'//group//why
      else if (repeats .and. bracket == percent) then
         why = 'which &'//group//'? write '//group//'(1)%'//key
      else if (.not. repeats .and. number /= 1) then
         why = 'there is one &'//group//' only'
      end if
      if (why /= '') why = quoted(written)//': '//why
   end subroutine read_key_name

   !> The number in a pair of brackets, -1 where there is none.
   pure integer function number_in(text)
      character(*), intent(in) :: text
      integer, parameter :: longest = 11
      integer :: last

      number_in = -1
      last = len(text)
      if (last < 3 .or. last > longest) return
      if (text(last:) == ')' .and. verify(text(2:last - 1), '0123456789') == 0) read (text(2:last - 1), *) number_in
   end function number_in

end module mfv_key_path
