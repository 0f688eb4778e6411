!> Names of keys with their groups: `friction%mu`, `body(2)%radius`.
module mfv_key_path
   use mfv_key_reader, only: suggest
   use mfv_keys, only: catalogue_type
   use mfv_strings, only: lower_case, quoted
   implicit none
   private
   public :: read_key_name

contains

   !> Group, number of the group and key of a name, which must be in a catalogue. `why`: what is wrong with it, empty where nothing
   !> is; whether there is a group of this number is for the caller to tell.
   subroutine read_key_name(written, catalogue, group, number, key, why)
      character(*), intent(in) :: written
      type(catalogue_type), intent(in) :: catalogue
      character(:), allocatable, intent(out) :: group, key, why
      integer, intent(out) :: number
      character(:), allocatable :: written_number

      call split_key(written, group, written_number, number, key, why)
      if (why /= '') return
      if (.not. catalogue%has_group(group)) then
         call suggest(group, catalogue%groups(), '', why)
         why = 'unknown group'//why//'; groups are '//catalogue%group_list
      else if (catalogue%place(group, key) == 0) then
         call suggest(key, catalogue%names(group), '', why)
         why = 'unknown key of &'//group//why
      else if (catalogue%repeats(group) .and. written_number == '') then
         why = 'which &'//group//'? write '//group//'(1)%'//key
      else if (.not. catalogue%repeats(group) .and. number /= 1) then
         why = 'there is one &'//group//' only'
      end if
      if (why /= '') why = quoted(written)//': '//why
   end subroutine read_key_name

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
