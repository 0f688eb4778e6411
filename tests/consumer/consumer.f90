!> A Fortran program of a user's: solves the case that its argument names and prints how many nodes are in contact.
program consumer
   use mfv
   implicit none
   type(contact_type) :: contact
   type(loads_type) :: loads
   type(error_type), allocatable :: error
   character(len=1000) :: path

   call get_command_argument(1, path)
   call read_contact(trim(path), contact, error)
   if (allocated(error)) error stop error%message
   call contact%run()
   if (contact%status() /= MFV_COMPLETE) error stop 'the load history ended early'
   loads = contact%loads()
   print '(a, i0)', 'contact nodes ', loads%contact_nodes
end program consumer
