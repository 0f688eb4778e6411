!> A folder for the files of a test, outside the working directory.
module temporary_folder
   use, intrinsic :: iso_c_binding, only: c_associated, c_char, c_int, c_null_char, c_ptr
   implicit none
   private
   public :: make_temporary_folder, remove_temporary_folder

   interface
      function c_mkdtemp(template) bind(C, name='mkdtemp') result(path)
         import :: c_char, c_ptr
         character(kind=c_char), intent(inout) :: template(*)
         type(c_ptr) :: path
      end function c_mkdtemp

      integer(c_int) function c_rmdir(path) bind(C, name='rmdir')
         import :: c_char, c_int
         character(kind=c_char), intent(in) :: path(*)
      end function c_rmdir
   end interface

contains

   !> A new folder in TMPDIR or /tmp, its path with the final slash; empty if it cannot be created.
   subroutine make_temporary_folder(path)
      character(:), allocatable, intent(out) :: path
      character(len=1000) :: parent

      call get_environment_variable('TMPDIR', parent)
      if (parent == '') parent = '/tmp'
      path = trim(parent)//'/mfv_test_XXXXXX'//c_null_char
      if (.not. c_associated(c_mkdtemp(path))) path = ' '
      path = path(:len(path) - 1)//'/'
   end subroutine make_temporary_folder

   !> Remove a folder, which must be empty.
   subroutine remove_temporary_folder(path)
      character(*), intent(in) :: path
      integer(c_int) :: code

      code = c_rmdir(path//c_null_char)
      if (code /= 0) error stop 'the temporary folder of a test is not empty'
   end subroutine remove_temporary_folder

end module temporary_folder
