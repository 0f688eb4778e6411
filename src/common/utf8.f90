!> Whether bytes are a text: UTF-8 (RFC 3629) without control characters, in lines that end with LF or CR LF.
module mfv_utf8
   use mfv_strings, only: to_text
   implicit none
   private
   public :: find_fault_of_text, byte_order_mark

   !> What some editors put before a text.
   character(*), parameter :: byte_order_mark = char(239)//char(187)//char(191)

   integer, parameter :: tab = 9, line_feed = 10, carriage_return = 13, blank = 32, delete = 127

contains

   !> What keeps `text` from being a text, empty where nothing does, and the line that it is in.
   pure subroutine find_fault_of_text(text, line, why)
      character(*), intent(in) :: text
      integer, intent(out) :: line
      character(:), allocatable, intent(out) :: why
      integer :: i, code, length

      why = ''
      line = 1
      i = 1
      do while (i <= len(text))
         code = ichar(text(i:i))
         length = 1
         if (code == carriage_return) then
            if (text(i + 1:min(i + 1, len(text))) /= achar(line_feed)) &
               why = 'a carriage return without a line feed; lines must end with LF or CR LF'
         else if (code == line_feed) then
            line = line + 1
         else if ((code < blank .and. code /= tab) .or. code == delete) then
            why = 'the control character '//to_text(code)//': this is no text'
         else if (code > delete) then
            call measure_character(text(i:min(i + 3, len(text))), length)
            if (length == 0) why = 'the byte '//to_text(code)//' is not UTF-8: save the text as UTF-8'
         end if
         if (why /= '') return
         i = i + length
      end do
   end subroutine find_fault_of_text

   !> Bytes of the character of more than one byte at the start of `bytes`; 0 where that is none.
   pure subroutine measure_character(bytes, length)
      character(*), intent(in) :: bytes
      integer, intent(out) :: length
      integer :: first, lowest, highest, i

      first = ichar(bytes(1:1))
      ! Leading bytes, and what may follow at once: no longer form than is needed, no surrogates, nothing above U+10FFFF.
      lowest = 128
      highest = 191
      select case (first)
      case (194:223)
         length = 2
      case (224:239)
         length = 3
         if (first == 224) lowest = 160
         if (first == 237) highest = 159
      case (240:244)
         length = 4
         if (first == 240) lowest = 144
         if (first == 244) highest = 143
      case default
         length = 0
      end select
      if (length > len(bytes)) length = 0
      do i = 2, length
         if (ichar(bytes(i:i)) >= lowest .and. ichar(bytes(i:i)) <= highest) then
            lowest = 128
            highest = 191
         else
            length = 0
         end if
      end do
   end subroutine measure_character

end module mfv_utf8
