!> The journal of a sweep: what has been computed so far, safe from the end of the process at any moment. A file that records
!> are appended to, each with its length and checksum; what is not whole at its end is cut off when it is opened again.
module mfv_sweep_journal
   use, intrinsic :: iso_fortran_env, only: int64, int8
   use mfv_checksum, only: checksum_of
   use mfv_error, only: error_type, set_error
   use mfv_locked_file
   use mfv_safe_file, only: describe_code
   use mfv_status, only: MFV_FILE_ERROR, MFV_INPUT_ERROR
   use mfv_sweep_record, only: is_record, record_number, record_type, unpack_record
   implicit none
   private
   public :: journal_type, open_journal, append_to_journal, sync_journal, close_journal, delete_journal, gather_journal

   type :: journal_type
      character(:), allocatable :: path
      !> Bytes at its end that were not whole, and that have been cut off.
      integer(int64) :: dropped = 0
      type(locked_file_type), private :: file
   end type journal_type

   character(*), parameter :: signature = 'mfv_sweep journal 1 '
   integer, parameter :: header_length = len(signature) + 16 + 1
   integer, parameter :: frame_length = 4, checksum_length = 8

contains

   !> Open the journal at `path` for a sweep with a checksum and a number of cases, made where it is not there. What it has is
   !> in `records`, shape (cases), by number. `again`: whether it is emptied. Error MFV_FILE_ERROR: it cannot be written, or
   !> another process has it; MFV_INPUT_ERROR: it is of another input, or no journal.
   subroutine open_journal(path, checksum, again, journal, records, error)
      character(*), intent(in) :: path
      integer(int64), intent(in) :: checksum
      logical, intent(in) :: again
      type(journal_type), intent(out) :: journal
      type(record_type), intent(inout) :: records(:)
      type(error_type), allocatable, intent(out) :: error
      integer(int8), allocatable :: bytes(:)
      integer(int64) :: whole
      integer :: code

      call open_path(path, journal, error)
      if (allocated(error)) return
      call read_bytes(journal%file, bytes)
      call check_header(path, bytes, checksum, again, error)
      if (allocated(error)) then
         call close_file(journal%file)
         return
      end if
      code = 0
      if (size(bytes) < header_length .or. again) then
         call cut_file(journal%file, 0_int64, code)
         if (code == 0) call append_bytes(journal%file, header_of(checksum), code)
         if (code == 0) call sync_name(path, code)
      else
         call read_records(bytes, records, whole)
         journal%dropped = size(bytes, kind=int64) - whole
         if (journal%dropped > 0) call cut_file(journal%file, whole, code)
      end if
      if (code /= 0) call set_error(error, MFV_FILE_ERROR, path//': the journal cannot be written')
   end subroutine open_journal

   !> Add what another journal of the same sweep has to `records`. `found`: whether it is one of the same input; `dropped`:
   !> bytes at its end that are not whole. Error MFV_FILE_ERROR where another process has it.
   subroutine gather_journal(path, checksum, records, found, error, dropped)
      character(*), intent(in) :: path
      integer(int64), intent(in) :: checksum
      type(record_type), intent(inout) :: records(:)
      logical, intent(out) :: found
      type(error_type), allocatable, intent(out) :: error
      integer(int64), intent(out), optional :: dropped
      type(journal_type) :: journal
      integer(int8), allocatable :: bytes(:)
      integer(int64) :: whole

      found = .false.
      if (present(dropped)) dropped = 0
      call open_path(path, journal, error)
      if (allocated(error)) return
      call read_bytes(journal%file, bytes)
      found = is_header_of(bytes, checksum)
      if (found) call read_records(bytes, records, whole)
      if (found .and. present(dropped)) dropped = size(bytes, kind=int64) - whole
      call close_file(journal%file)
   end subroutine gather_journal

   subroutine open_path(path, journal, error)
      character(*), intent(in) :: path
      type(journal_type), intent(out) :: journal
      type(error_type), allocatable, intent(out) :: error
      integer :: outcome

      journal%path = path
      call open_locked(path, journal%file, outcome)
      if (outcome == not_opened) call set_error(error, MFV_FILE_ERROR, path//': the journal cannot be opened')
      if (outcome == in_use) call set_error(error, MFV_FILE_ERROR, path//': another process is at work on this sweep')
      if (outcome == cannot_lock) &
         call set_error(error, MFV_FILE_ERROR, path//': the file system cannot lock files; without a lock two processes could '// &
                        'spoil the journal: let &sweep file= name a place on another one')
   end subroutine open_path

   !> Error MFV_INPUT_ERROR where the bytes are no journal, or, unless `again`, one of another input.
   subroutine check_header(path, bytes, checksum, again, error)
      character(*), intent(in) :: path
      integer(int8), intent(in) :: bytes(:)
      integer(int64), intent(in) :: checksum
      logical, intent(in) :: again
      type(error_type), allocatable, intent(out) :: error
      integer(int8) :: expected(header_length)
      integer :: length

      expected = header_of(checksum)
      length = min(size(bytes), len(signature))
      if (any(bytes(:length) /= expected(:length))) then
         call set_error(error, MFV_INPUT_ERROR, path//' is there and is no journal of mfv_sweep; it is not replaced')
         return
      end if
      length = min(size(bytes), header_length)
      if (any(bytes(:length) /= expected(:length)) .and. .not. again) &
         call set_error(error, MFV_INPUT_ERROR, path//': this journal is of another input (the sweep, a base case, a file '// &
                        'that they name, the version, or the list of observables has changed); --again starts anew and '// &
                        'drops it')
   end subroutine check_header

   !> Whether bytes begin as the journal of a sweep with this checksum.
   pure logical function is_header_of(bytes, checksum)
      integer(int8), intent(in) :: bytes(:)
      integer(int64), intent(in) :: checksum

      is_header_of = .false.
      if (size(bytes) >= header_length) is_header_of = all(bytes(:header_length) == header_of(checksum))
   end function is_header_of

   !> The first line of the journal.
   pure function header_of(checksum) result(header)
      integer(int64), intent(in) :: checksum
      integer(int8) :: header(header_length)
      character(len=header_length) :: text

      write (text, '(a,z16.16,a)') signature, checksum, achar(10)
      header = transfer(text, header)
   end function header_of

   !> The records in the bytes of a journal. `whole`: how many of the bytes are right.
   subroutine read_records(bytes, records, whole)
      integer(int8), intent(in) :: bytes(:)
      type(record_type), intent(inout) :: records(:)
      integer(int64), intent(out) :: whole
      integer(int64) :: first, last
      integer :: length, number

      whole = header_length
      do
         if (whole + frame_length > size(bytes, kind=int64)) return
         length = transfer(bytes(whole + 1:whole + frame_length), length)
         if (length < 1) return
         first = whole + frame_length + 1
         last = whole + frame_length + length
         if (last + checksum_length > size(bytes, kind=int64)) return
         if (checksum_of(bytes(whole + 1:last)) /= transfer(bytes(last + 1:last + checksum_length), 0_int64)) return
         if (.not. is_record(bytes(first:last))) return
         number = record_number(bytes(first:last))
         if (number >= 1 .and. number <= size(records)) then
            if (records(number)%number == 0) call unpack_record(bytes(first:last), records(number))
         end if
         whole = last + checksum_length
      end do
   end subroutine read_records

   !> Append a record as bytes. Error MFV_FILE_ERROR.
   subroutine append_to_journal(journal, bytes, error)
      type(journal_type), intent(inout) :: journal
      integer(int8), intent(in) :: bytes(:)
      type(error_type), allocatable, intent(out) :: error
      integer(int8), allocatable :: frame(:)
      integer :: code, length

      length = size(bytes)
      allocate (frame(frame_length + length + checksum_length))
      frame(:frame_length) = transfer(length, frame)
      frame(frame_length + 1:frame_length + length) = bytes
      frame(frame_length + length + 1:) = transfer(checksum_of(frame(:frame_length + length)), frame)
      call append_bytes(journal%file, frame, code)
      if (code /= 0) call set_error(error, MFV_FILE_ERROR, journal%path//': the journal cannot be written; what it has is safe')
   end subroutine append_to_journal

   !> Make the journal safe from the end of the machine. Error MFV_FILE_ERROR.
   subroutine sync_journal(journal, error)
      type(journal_type), intent(in) :: journal
      type(error_type), allocatable, intent(inout) :: error
      character(:), allocatable :: why
      integer :: code

      call sync_file(journal%file, code)
      if (code == 0 .or. allocated(error)) return
      call describe_code(code, why)
      call set_error(error, MFV_FILE_ERROR, journal%path//': the journal cannot be brought to the disk: '//why)
   end subroutine sync_journal

   !> Close the journal, safe from the end of the machine. Error MFV_FILE_ERROR where it is not; an error that is there stays.
   subroutine close_journal(journal, error)
      type(journal_type), intent(inout) :: journal
      type(error_type), allocatable, intent(inout) :: error

      call sync_journal(journal, error)
      call close_file(journal%file)
   end subroutine close_journal

   !> Delete the journal, before its lock is given back.
   subroutine delete_journal(journal)
      type(journal_type), intent(inout) :: journal

      call delete_path(journal%path)
      call close_file(journal%file)
   end subroutine delete_journal

end module mfv_sweep_journal
