!> The summary of a result, for a terminal.
module mfv_summary
   use mfv_case, only: case_type
   use mfv_contact_model, only: contact_model_type, new_contact_model
   use mfv_kinds, only: wp
   use mfv_result_fields, only: field_type, group_fields
   use mfv_simulation, only: simulation_type
   use mfv_status, only: status_outcome
   use mfv_strings, only: string_type, to_text
   implicit none
   private
   public :: summary_text, check_text, unit_suffix

   character(len=1), parameter :: line_feed = achar(10)

contains

   !> What came out, one quantity a line. `warnings`: see mfv_validity. `seconds`: time the run took.
   function summary_text(case, simulation, warnings, seconds) result(text)
      type(case_type), intent(in) :: case
      type(simulation_type), intent(in) :: simulation
      type(string_type), intent(in) :: warnings(:)
      real(wp), intent(in) :: seconds
      character(:), allocatable :: text
      type(field_type), allocatable :: fields(:)
      integer :: i

      call group_fields(case, simulation, 'summary', fields)
      text = line('outcome', status_outcome(simulation%outcome)//': '//simulation%message) &
             //line('contact half-width', amount(fields, 'contact_half_width')) &
             //line('nodes', to_text(simulation%contact%model%nodes())//', in contact '//amount(fields, 'contact_nodes')// &
                    ', stuck '//amount(fields, 'stick_nodes')//', slipping '//amount(fields, 'slip_nodes'))
      if (simulation%contact%model%tangential) text = text//line('stick ratio', amount(fields, 'stick_ratio'))
      text = text//line('normal force', amount(fields, 'normal_force')//', approach '//amount(fields, 'approach'))
      if (simulation%contact%model%tangential) text = text//line('tangential force', amount(fields, 'tangential_force')// &
                                                                 ', shift '//amount(fields, 'shift')) &
                                                      //line('dissipation', amount(fields, 'dissipation'))
      if (simulation%contact%model%rotational) text = text//line('moment', amount(fields, 'moment')//', rotation '// &
                                                                 amount(fields, 'rotation'))
      text = text//line('work', amount(fields, 'events')//' events, '//amount(fields, 'linear_solves')// &
                        ' linear solves, '//to_text(seconds, 3)//' s') &
             //line('compliance', compliance_text(simulation%contact%model)) &
             //line('certificate', 'largest relative residual '//amount(fields, 'largest_residual'))
      do i = 1, size(warnings)
         text = text//line('warning', warnings(i)%text)
      end do
      if (simulation%contact%model%added > 0) text = text//line('mesh', 'grew by '// &
                                                                to_text(simulation%contact%model%added)// &
                                                                ' nodes at either end')
   end function summary_text

   !> Which blocks the scene needed, the memory of what they are made from, and the time that took.
   function compliance_text(model) result(text)
      type(contact_model_type), intent(in) :: model
      character(:), allocatable :: text
      character(*), parameter :: blocks(4) = ['C_wp', 'C_wt', 'C_up', 'C_ut'], bodies(2) = ['lower', 'upper']
      integer :: i

      text = ''
      do i = 1, size(blocks)
         if (model%compliance%has_block(i)) text = text//' '//blocks(i)
      end do
      text = text(2:)
      do i = 1, size(bodies)
         text = text//', '//bodies(i)//' body '
         if (model%compliance%deforms(i)) then
            text = text//to_text(int(model%compliance%part(i)%compliance%bytes()))//' bytes'
         else
            text = text//'rigid'
         end if
      end do
      text = text//', '//to_text(model%assembly_seconds, 2)//' s'
   end function compliance_text

   !> What a valid case asks for.
   function check_text(case) result(text)
      type(case_type), intent(in) :: case
      character(:), allocatable :: text
      type(contact_model_type) :: model

      model = new_contact_model(case%scene)
      text = line('case', case%source//' is valid') &
             //line('title', case%scene%title) &
             //line('compliance', compliance_text(model)) &
             //line('mesh', to_text(model%nodes())//' nodes over |x| < '//to_text(model%length())// &
                    trim(merge(', growing', '         ', model%growing))) &
             //line('steps', to_text(size(case%scene%steps)))
      if (case%result_path /= '') text = text//line('result', case%result_path)
   end function check_text

   function line(label, value) result(text)
      character(*), intent(in) :: label, value
      character(:), allocatable :: text
      character(len=20) :: padded

      padded = label
      text = padded//value//line_feed
   end function line

   !> The value of a field, with its unit where it has one.
   function amount(fields, name) result(text)
      type(field_type), intent(in) :: fields(:)
      character(*), intent(in) :: name
      character(:), allocatable :: text
      integer :: i

      text = ''
      do i = 1, size(fields)
         if (fields(i)%name /= name) cycle
         if (allocated(fields(i)%whole)) then
            text = to_text(fields(i)%whole(1))
         else
            text = to_text(fields(i)%values(1))
         end if
         text = text//unit_suffix(fields(i)%unit)
      end do
   end function amount

   !> A unit to stand after a value: empty unless the user has named the units.
   pure function unit_suffix(unit) result(suffix)
      character(*), intent(in) :: unit
      character(:), allocatable :: suffix

      suffix = ''
      if (unit /= '1' .and. index(unit, 'length') == 0 .and. index(unit, 'force') == 0) suffix = ' '//unit
   end function unit_suffix

end module mfv_summary
