!> A Fortran program of a user's: solves the case that its argument names and prints how many nodes are in contact.
program consumer
   use mfv_case, only: case_type
   use mfv_case_reader, only: read_case_file
   use mfv_error, only: error_type
   use mfv_result_fields, only: field_named, field_type, group_fields
   use mfv_simulation, only: new_simulation, simulation_type
   use mfv_status, only: MFV_COMPLETE
   implicit none
   type(case_type) :: case
   type(simulation_type) :: simulation
   type(error_type), allocatable :: error
   type(field_type), allocatable :: fields(:)
   character(len=1000) :: path

   call get_command_argument(1, path)
   call read_case_file(trim(path), case, error)
   if (allocated(error)) error stop error%message
   simulation = new_simulation(case%scene, case%keep_history)
   call simulation%run()
   if (simulation%outcome /= MFV_COMPLETE) error stop simulation%message
   call group_fields(case, simulation, 'summary', fields)
   print '(a, i0)', 'contact nodes ', fields(field_named(fields, 'contact_nodes'))%whole(1)
end program consumer
