!> Checkpoints: a run as it is between two increments, in a file, to go on from with the same digits after the end of the process.
!>
!> The file begins with two lines of text: what it is, and where the run is. Then come the checksum of the case, the length of the
!> image (mfv_archive), the image, and the checksum of all that. It is of use to the same version on the same sort of machine. It is
!> replaced as results are (mfv_safe_file): whenever the machine stops, there is the old one or the new one.
module mfv_checkpoint
   use, intrinsic :: iso_fortran_env, only: compiler_version, int64, int8
   use mfv_archive, only: archive_type, new_archive
   use mfv_case, only: case_type
   use mfv_case_checksum, only: find_case_checksum
   use mfv_checksum, only: add_text_to_checksum, add_to_checksum, checksum_of
   use mfv_error, only: error_type, set_error
   use mfv_kinds, only: wp
   use mfv_safe_file, only: begin_replacement, delete_path, finish_replacement, replacement_type, write_replacement
   use mfv_simulation, only: simulation_type
   use mfv_status, only: MFV_FILE_ERROR, MFV_INPUT_ERROR
   use mfv_strings, only: to_text
   use mfv_text_file, only: check_is_file
   use mfv_version, only: library_version
   implicit none
   private
   public :: checkpoint_type, new_checkpoint

   character(*), parameter :: signature = 'MFV checkpoint '
   !> To be raised when what an image is made of changes within a version.
   integer, parameter :: layout = 2
   !> Bytes of a number; and of both lines, blanks and line feed with them.
   integer, parameter :: number_length = 8, line_length = 120
   integer, parameter :: header_length = 2*line_length + 2*number_length

   type :: checkpoint_type
      !> The file: beside the result, under the same name with `.checkpoint` in place of `.h5`. Another extension stays: results
      !> mu0.3 and mu0.5 have checkpoints of their own.
      character(:), allocatable :: path
      character(:), allocatable, private :: source
      !> By what the case is known.
      integer(int64), private :: checksum = 0
   contains
      procedure :: is_there
      procedure :: write => write_checkpoint
      procedure :: read => read_checkpoint
      procedure :: remove
      procedure, private :: check_frame
   end type checkpoint_type

contains

   !> The checkpoint of a simulation of `case` that has just been made.
   subroutine new_checkpoint(case, simulation, checkpoint)
      type(case_type), intent(in) :: case
      type(simulation_type), intent(in) :: simulation
      type(checkpoint_type), intent(out) :: checkpoint

      checkpoint%path = case%result_path(:length_of_name(case%result_path))//'.checkpoint'
      checkpoint%source = case%source
      call find_case_checksum(case, simulation%contact%model, checkpoint%checksum)
      call add_text_to_checksum(to_text(case%scene%method%algorithm), checkpoint%checksum)
   end subroutine new_checkpoint

   !> Characters of the path of a result up to `.h5`, or all where it does not end so.
   pure integer function length_of_name(path) result(length)
      character(*), intent(in) :: path
      character(*), parameter :: extension = '.h5'

      length = len(path)
      if (len(path) > len(extension)) then
         if (path(len(path) - len(extension) + 1:) == extension) length = len(path) - len(extension)
      end if
   end function length_of_name

   !> Whether there is a checkpoint, of this case or another.
   logical function is_there(self)
      class(checkpoint_type), intent(in) :: self
      type(error_type), allocatable :: error
      character(len=len(signature)) :: start
      integer :: code, unit

      is_there = .false.
      call check_is_file(self%path, error)
      if (allocated(error)) return
      open (newunit=unit, file=self%path, access='stream', form='unformatted', action='read', status='old', iostat=code)
      if (code /= 0) return
      read (unit, iostat=code) start
      if (code == 0) is_there = start == signature
      close (unit)
   end function is_there

   !> Remove the checkpoint; a file that is none stays.
   subroutine remove(self)
      class(checkpoint_type), intent(in) :: self

      if (self%is_there()) call delete_path(self%path)
   end subroutine remove

   !> Write where a simulation of the case is (it stays as it is: one procedure writes and reads). Error MFV_FILE_ERROR: a
   !> checkpoint that was there still is; so is a file that is none, which is not replaced.
   subroutine write_checkpoint(self, simulation, error)
      class(checkpoint_type), intent(in) :: self
      type(simulation_type), intent(inout) :: simulation
      type(error_type), allocatable, intent(out) :: error
      type(archive_type) :: archive
      type(replacement_type) :: replacement
      integer(int8), allocatable :: image(:), header(:)
      integer(int8) :: mold(1)
      integer(int64) :: checksum
      logical :: is_other

      inquire (file=self%path, exist=is_other)
      if (is_other) is_other = .not. self%is_there()
      if (is_other) then
         call set_error(error, MFV_FILE_ERROR, self%path//' is there and is no checkpoint; it is not replaced')
         return
      end if
      call new_archive(archive)
      call simulation%carry(archive)
      call archive%take_bytes(image)
      header = [transfer(first_line(), mold), transfer(second_line(self%source, simulation), mold), &
                transfer([self%checksum, size(image, kind=int64)], mold)]
      checksum = checksum_of(header)
      call add_to_checksum(image, checksum)
      call begin_replacement(self%path, replacement, error)
      if (.not. allocated(error)) call write_replacement(replacement, header, error)
      if (.not. allocated(error)) call write_replacement(replacement, image, error)
      if (.not. allocated(error)) call write_replacement(replacement, transfer(checksum, mold), error)
      if (.not. allocated(error)) call finish_replacement(replacement, error)
   end subroutine write_checkpoint

   !> Bring a new simulation of the case to where the checkpoint was written. Error MFV_INPUT_ERROR: it cannot be read, is no
   !> checkpoint, of another version, of another case, or damaged; the simulation is then of no use.
   subroutine read_checkpoint(self, simulation, error)
      class(checkpoint_type), intent(in) :: self
      type(simulation_type), intent(inout) :: simulation
      type(error_type), allocatable, intent(out) :: error
      type(archive_type) :: archive
      integer(int8), allocatable :: bytes(:)

      call read_bytes(self%path, bytes, error)
      if (.not. allocated(error)) call self%check_frame(bytes, error)
      if (allocated(error)) return
      call new_archive(archive, bytes(header_length + 1:size(bytes, kind=int64) - number_length))
      call simulation%carry(archive)
      if (archive%is_damaged() .or. .not. archive%is_at_end()) call complain(self%path, 'is not as this program writes it', error)
   end subroutine read_checkpoint

   !> Look at all bytes but the image.
   subroutine check_frame(self, bytes, error)
      class(checkpoint_type), intent(in) :: self
      integer(int8), intent(in) :: bytes(:)
      type(error_type), allocatable, intent(out) :: error
      integer(int64) :: numbers(2), checksum, length
      integer(int8) :: mold(1)

      length = size(bytes, kind=int64)
      if (.not. begins_with(bytes, transfer(signature, mold))) then
         call complain(self%path, 'is no checkpoint', error)
      else if (.not. begins_with(bytes, transfer(first_line(), mold))) then
         call complain(self%path, 'is of another version of this program', error)
      else if (length < header_length + number_length) then
         call complain(self%path, 'is not whole', error)
      end if
      if (allocated(error)) return
      numbers = transfer(bytes(2*line_length + 1:header_length), numbers)
      checksum = transfer(bytes(length - number_length + 1:), checksum)
      if (numbers(2) /= length - header_length - number_length) then
         call complain(self%path, 'is not whole', error)
      else if (checksum /= checksum_of(bytes(:length - number_length))) then
         call complain(self%path, 'is damaged', error)
      else if (numbers(1) /= self%checksum) then
         call complain(self%path, 'is of another case: the text, a file that it names, or the algorithm has changed', error)
      end if
   end subroutine check_frame

   !> Error MFV_INPUT_ERROR: why a checkpoint cannot be used, and what is to be done.
   subroutine complain(path, why, error)
      character(*), intent(in) :: path, why
      type(error_type), allocatable, intent(out) :: error

      call set_error(error, MFV_INPUT_ERROR, path//' '//why//'; without --resume the case begins anew')
   end subroutine complain

   pure logical function begins_with(bytes, start)
      integer(int8), intent(in) :: bytes(:), start(:)

      begins_with = size(bytes, kind=int64) >= size(start)
      if (begins_with) begins_with = all(bytes(:size(start)) == start)
   end function begins_with

   !> The line that a checkpoint of this version, by this compiler, begins with.
   pure function first_line() result(line)
      character(len=line_length) :: line

      line = signature//'of mfv '//library_version//', layout '//to_text(layout)//', reals of '// &
             to_text(storage_size(1.0_wp))//' bits, '//compiler_version()
      line(line_length:) = achar(10)
   end function first_line

   !> The line that tells people where the run is.
   pure function second_line(source, simulation) result(line)
      character(*), intent(in) :: source
      type(simulation_type), intent(in) :: simulation
      character(len=line_length) :: line
      integer, parameter :: longest_source = 60

      line = source(max(len(source) - longest_source, 0) + 1:)
      line = trim(line)//': '//to_text(simulation%scene_steps_done)//' of '// &
             to_text(size(simulation%contact%model%scene%steps))//' steps and '//to_text(simulation%contact%events)// &
             ' events done'
      line(line_length:) = achar(10)
   end function second_line

   !> All bytes of a file. Error MFV_INPUT_ERROR.
   subroutine read_bytes(path, bytes, error)
      character(*), intent(in) :: path
      integer(int8), allocatable, intent(out) :: bytes(:)
      type(error_type), allocatable, intent(out) :: error
      character(len=200) :: why
      integer(int64) :: length
      integer :: code, unit

      call check_is_file(path, error)
      if (allocated(error)) return
      open (newunit=unit, file=path, access='stream', form='unformatted', action='read', status='old', iostat=code, iomsg=why)
      if (code == 0) then
         inquire (unit=unit, size=length)
         allocate (bytes(max(length, 0_int64)), stat=code)
         if (code == 0) then
            read (unit, iostat=code, iomsg=why) bytes
         else
            why = 'there is no memory for it'
         end if
         close (unit)
      end if
      if (code /= 0) call set_error(error, MFV_INPUT_ERROR, path//': cannot be read: '//trim(why))
   end subroutine read_bytes

end module mfv_checkpoint
