!> The summary of a result, for a terminal.
module mfv_summary
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use mfv_body, only: body_names
   use mfv_case, only: case_type
   use mfv_contact_model, only: contact_model_type, new_contact_model
   use mfv_interior, only: has_interior
   use mfv_kinds, only: pi, wp
   use mfv_load_extremes, only: over_rows, over_steps
   use mfv_motions, only: motions, motion_count => user_motions, motion_rotation, bulk_motions
   use mfv_observables, only: observable_place, observed_type
   use mfv_result_fields, only: field_named, field_type, group_fields
   use mfv_simulation, only: simulation_type
   use mfv_status, only: status_outcome
   use mfv_strings, only: line_feed, string_type, to_text
   use mfv_tolerances, only: visible
   implicit none
   private
   public :: summarize, summarize_check, unit_suffix

contains

   !> The result, one quantity per line. `warnings`: see mfv_validity; `observed`: see mfv_observables. `seconds`: wall-clock time
   !> of the run.
   subroutine summarize(case, simulation, warnings, observed, seconds, text)
      type(case_type), intent(in) :: case
      type(simulation_type), intent(in) :: simulation
      type(string_type), intent(in) :: warnings(:)
      type(observed_type), intent(in) :: observed
      real(wp), intent(in) :: seconds
      character(:), allocatable, intent(out) :: text
      type(field_type), allocatable :: fields(:), seen(:)
      character(:), allocatable :: words
      integer :: i

      call group_fields(case, simulation, 'summary', fields)
      text = ''
      associate (model => simulation%contact%model)
         call add_line(text, 'outcome', status_outcome(simulation%outcome)//': '//simulation%message)
         call group_fields(case, simulation, 'observables', seen, observed)
         call add_extremes(text, seen, simulation)
         call add_contact(text, fields, observed, model)
         call add_line(text, 'nodes', to_text(model%nodes())//', in contact '//amount(fields, 'contact_nodes')// &
                       ', stuck '//amount(fields, 'stick_nodes')//', slipping '//amount(fields, 'slip_nodes'))
         if (model%tangential) call add_line(text, 'stick ratio', amount(fields, 'stick_ratio'))
         call add_line(text, 'normal force', amount(fields, 'normal_force')//', approach '//amount(fields, 'approach'))
         if (model%tangential) then
            call add_line(text, 'tangential force', amount(fields, 'tangential_force')//', shift '//amount(fields, 'shift'))
            call add_line(text, 'dissipation', amount(fields, 'dissipation'))
         end if
         if (model%scene%wear%acts()) call add_line(text, 'wear', 'worn area '//amount(seen, 'worn_area')//', largest depth '// &
                                                    amount(seen, 'wear_depth')//', '//amount(seen, 'cycles')//' cycles')
         if (simulation%cycle_count > 0) call add_last_cycle(text, seen, simulation%cycles(simulation%cycle_count)%walks())
         do i = 1, motion_count
            if (.not. (motions(i)%optional .and. model%moves(i))) cycle
            if (motions(i)%is_stress) then
               call add_line(text, motions(i)%key(:5)//' bulk stress', amount(fields, trim(motions(i)%key)))
            else
               call add_line(text, trim(motions(i)%force_name), amount(fields, trim(motions(i)%force_key))//', '// &
                             trim(motions(i)%key)//' '//amount(fields, trim(motions(i)%key)))
            end if
         end do
         if (model%moves(motion_rotation) .and. field_named(seen, 'creepage_number') > 0) &
            call add_line(text, 'creepage', amount(seen, 'creepage')//', over mu a K '//amount(seen, 'creepage_number'))
         call add_tension(text, seen, model, simulation%contact%state%contact_nodes() > 0)
         words = ''
         if (simulation%contact%certificate%large_increments > 0) words = amount(fields, 'leaps')//' large increments, '
         if (simulation%contact%certificate%large_increments == 1) words = '1 large increment, '
         words = trim(numbered(simulation%contact%events, 'event'))//', '//words
         words = words//trim(numbered(simulation%contact%system%solves, 'linear solve'))
         call add_line(text, 'work', words//' ('//trim(simulation%contact%system%name)//'), '//to_text(seconds, 3)//' s')
         call add_line(text, 'certificate', 'largest relative residual '//amount(fields, 'largest_residual'))
         if (max(simulation%contact%certificate%increment_traction_error, &
                 simulation%contact%certificate%increment_dissipation_error) > 0.0_wp) &
            call add_line(text, 'large increments', 'estimated errors: '// &
                          to_text(simulation%contact%certificate%increment_traction_error, 2)// &
                          trim(merge(' of the tractions (root mean square), ', ' of the largest traction,             ', &
                                     simulation%contact%certificate%by_mean_square))//' '// &
                          to_text(simulation%contact%certificate%increment_dissipation_error, 2)// &
                          ' of the dissipation of a load segment')
         if (allocated(simulation%estimate)) call add_estimate(text, seen, case, simulation)
         if (allocated(simulation%sensitivity)) call add_sensitivity(text, simulation)
         do i = 1, size(warnings)
            call add_line(text, 'warning', warnings(i)%text)
         end do
         if (model%added > 0) call add_line(text, 'mesh', 'grew by '//to_text(model%added)//' nodes at either end')
      end associate
   end subroutine summarize

   !> The size of the contact: the half-width of one patch, or the total length of several patches and their number. With radial
   !> normals lengths are along the surface, and the contact is between two angles.
   subroutine add_contact(text, fields, observed, model)
      character(:), allocatable, intent(inout) :: text
      type(field_type), intent(in) :: fields(:)
      type(observed_type), intent(in) :: observed
      type(contact_model_type), intent(in) :: model
      character(:), allocatable :: span

      span = ''
      associate (patches => fields(field_named(fields, 'patches'))%whole(1))
         if (patches > 0) span = ' from x = '//amount(fields, 'contact_left')//' to '//amount(fields, 'contact_right')
         if (patches > 1) then
            call add_line(text, 'contact length', amount(fields, 'contact_length')//' in '//to_text(patches)//' patches'//span)
         else
            span = ''
            if (model%scene%mesh%radial .and. patches == 1) span = ' along the surface, '//trim(angles(observed, model))
            call add_line(text, 'contact half-width', amount(fields, 'contact_half_width')//span)
         end if
      end associate
   end subroutine add_contact

   !> The angles of a contact of one patch from the origin of x.
   pure function angles(observed, model) result(text)
      type(observed_type), intent(in) :: observed
      type(contact_model_type), intent(in) :: model
      character(len=60) :: text
      real(wp), parameter :: degrees = 180.0_wp/pi
      real(wp) :: half, middle

      half = observed%value('contact_half_width')/model%scene%arc_radius()
      middle = observed%value('contact_centre')/model%scene%arc_radius()
      text = 'all around'
      if (half < pi*(1.0_wp - visible)) text = 'from '//to_text((middle - half)*degrees, 4)//' to '// &
                                               to_text((middle + half)*degrees, 4)//' degrees'
   end function angles

   !> Observables of the last cycle. `walks`: whether the upper body does.
   subroutine add_last_cycle(text, fields, walks)
      character(:), allocatable, intent(inout) :: text
      type(field_type), intent(in) :: fields(:)
      logical, intent(in) :: walks
      character(:), allocatable :: words

      if (field_named(fields, 'cycle_dissipation') == 0) return
      words = 'dissipation '//amount(fields, 'cycle_dissipation')
      if (field_named(fields, 'loss_factor') > 0) words = words//', loss factor '//amount(fields, 'loss_factor')
      if (field_named(fields, 'tangential_stiffness') > 0) &
         words = words//', stiffness '//amount(fields, 'tangential_stiffness')
      words = words//', tractions change by '//amount(fields, 'cycle_change')
      if (walks) words = words//', shift drifts by '//amount(fields, 'shift_drift')
      call add_line(text, 'last cycle', words)
   end subroutine add_last_cycle

   !> The largest tension along the surface of each body, or that it is singular: then there is no observable.
   subroutine add_tension(text, fields, model, touches)
      character(:), allocatable, intent(inout) :: text
      type(field_type), intent(in) :: fields(:)
      type(contact_model_type), intent(in) :: model
      logical, intent(in) :: touches
      character(:), allocatable :: words
      logical :: has_stresses(2)
      integer :: i

      words = ''
      has_stresses = [has_interior(model%scene%lower), has_interior(model%scene%upper)]
      do i = 1, size(body_names)
         if (field_named(fields, body_names(i)//'_tension_x') > 0) then
            words = words//', '//body_names(i)//' body '//amount(fields, body_names(i)//'_tension')//' at x = '// &
                    amount(fields, body_names(i)//'_tension_x')
         else if (model%moves(bulk_motions(i)) .and. field_named(fields, body_names(i)//'_tension') > 0) then
            words = words//', '//body_names(i)//' body '//amount(fields, body_names(i)//'_tension')//' far from the contact'
         else if (touches .and. has_stresses(i) .and. field_named(fields, body_names(i)//'_tension') == 0) then
            words = words//', '//body_names(i)//' body singular at a sharp corner'
         end if
      end do
      if (words /= '') call add_line(text, 'tension at the end', words(3:))
   end subroutine add_tension

   !> Extremes over the last cycle, the rows of &history or the steps.
   subroutine add_extremes(text, fields, simulation)
      character(:), allocatable, intent(inout) :: text
      type(field_type), intent(in) :: fields(:)
      type(simulation_type), intent(in) :: simulation
      character(:), allocatable :: over

      if (.not. shows_extremes(fields, simulation)) return
      over = 'over all steps: '
      if (simulation%stretch() == over_rows) over = 'over all rows: '
      if (simulation%ends_with_cycle()) over = 'over the last cycle: '
      call add('largest tension', 'lower body', 'largest_lower_tension', 'upper body', 'largest_upper_tension')
      call add('largest tractions', 'pressure', 'largest_pressure', 'shear', 'largest_shear')
      call add('largest von Mises', 'lower body', 'largest_lower_von_mises', 'upper body', 'largest_upper_von_mises')
      call add('lower interfaces', 'tension', 'largest_lower_interface_tension', 'shear', 'largest_lower_interface_shear')
      call add('upper interfaces', 'tension', 'largest_upper_interface_tension', 'shear', 'largest_upper_interface_shear')
      call add('largest slip range', 'of a node', 'largest_slip_range', '', '')
      call add('stick ratio', 'smallest', 'smallest_stick_ratio', 'largest', 'largest_stick_ratio')

   contains

      !> A line with one or two extremes, where they exist.
      subroutine add(label, first, name_of_first, second, name_of_second)
         character(*), intent(in) :: label, first, name_of_first, second, name_of_second
         character(:), allocatable :: words

         words = ''
         call add_extreme(words, first, name_of_first)
         call add_extreme(words, second, name_of_second)
         if (words /= '') call add_line(text, label, over//words(3:))
      end subroutine add

      !> Add an extreme, if it exists, with its place, and where in the load history it occurs.
      subroutine add_extreme(words, label, name)
         character(:), allocatable, intent(inout) :: words
         character(*), intent(in) :: label, name
         character(*), parameter :: places(3) = [character(16) :: ' (step', ' (turning point', ' (row']

         if (field_named(fields, name) == 0) return
         words = words//', '//label//' '//amount(fields, name)
         if (field_named(fields, name//'_x') > 0) words = words//' at x = '//amount(fields, name//'_x')
         if (field_named(fields, name//'_row') > 0) &
            words = words//trim(places(simulation%stretch()))//' '//amount(fields, name//'_row')//')'
      end subroutine add_extreme
   end subroutine add_extremes

   !> Whether the summary has extremes: of steps only if they exceed the values at the end, or with layers.
   logical function shows_extremes(fields, simulation)
      type(field_type), intent(in) :: fields(:)
      type(simulation_type), intent(in) :: simulation
      character(*), parameter :: names(4) = [character(13) :: 'lower_tension', 'upper_tension', 'pressure', 'shear']
      integer :: i

      shows_extremes = simulation%stretch() /= over_steps .or. simulation%contact%model%scene%is_layered()
      do i = 1, size(names)
         shows_extremes = shows_extremes .or. is_above_end(trim(names(i)))
      end do

   contains

      !> Whether the largest value exceeds the one at the end by more than a rounding error.
      pure logical function is_above_end(name)
         character(*), intent(in) :: name
         integer :: largest, last

         largest = field_named(fields, 'largest_'//name)
         last = max(field_named(fields, name), field_named(fields, 'peak_'//name))
         is_above_end = largest > 0 .and. last > 0
         ! NaN: singular.
         if (is_above_end) is_above_end = ieee_is_finite(fields(largest)%values(1)) .and. ieee_is_finite(fields(last)%values(1))
         if (is_above_end) is_above_end = fields(largest)%values(1) > (1.0_wp + visible)*fields(last)%values(1)
      end function is_above_end
   end function shows_extremes

   !> Memory of the kernels or matrices, and time of assembly.
   subroutine add_compliance(text, model)
      character(:), allocatable, intent(inout) :: text
      type(contact_model_type), intent(in) :: model
      character(:), allocatable :: words
      integer :: i

      words = ''
      do i = 1, size(body_names)
         words = words//', '//body_names(i)//' body '
         if (model%compliance%deforms(i)) then
            words = words//to_text(int(model%compliance%body(i)%compliance%bytes()))//' bytes'
         else
            words = words//'rigid'
         end if
      end do
      call add_line(text, 'compliance', words(3:)//', assembled in '//to_text(model%assembly_seconds, 2)//' s')
   end subroutine add_compliance

   !> Values with their error bars, one per line, or why there are none: of the observables that the summary shows; the file has the
   !> bars of all.
   subroutine add_estimate(text, seen, case, simulation)
      character(:), allocatable, intent(inout) :: text
      type(field_type), intent(in) :: seen(:)
      type(case_type), intent(in) :: case
      type(simulation_type), intent(in) :: simulation
      character(*), parameter :: names(34) = [character(31) :: &
                 'largest_lower_tension', 'largest_upper_tension', 'largest_pressure', 'largest_shear', 'largest_lower_von_mises', &
                                    'largest_upper_von_mises', 'largest_lower_interface_tension', 'largest_lower_interface_shear', &
                 'largest_upper_interface_tension', 'largest_upper_interface_shear', 'largest_slip_range', 'smallest_stick_ratio', &
                      'largest_stick_ratio', 'contact_length', 'contact_half_width', 'stick_ratio', 'peak_pressure', 'peak_shear', &
                         'normal_force', 'approach', 'tangential_force', 'shift', 'dissipation', 'lower_tension', 'upper_tension', &
                                         'cycle_dissipation', 'tangential_stiffness', 'secant_stiffness', 'loss_factor', 'moment', &
                                              'rotation', 'creepage', 'worn_area', 'wear_depth']
      !> The first ones are extremes over the last cycle, rows or steps.
      integer, parameter :: extremes = 13
      character(*), parameter :: words(size(names)) = [character(38) :: &
                            'largest tension of lower body', 'largest tension of upper body', 'largest pressure', 'largest shear', &
                'largest von Mises stress of lower body', 'largest von Mises stress of upper body', 'tension at lower interfaces', &
                    'shear at lower interfaces', 'tension at upper interfaces', 'shear at upper interfaces', 'largest slip range', &
            'smallest stick ratio', 'largest stick ratio', 'contact length', 'contact half-width', 'stick ratio', 'peak pressure', &
                    'peak shear', 'normal force', 'approach', 'tangential force', 'shift', 'dissipation', 'tension of lower body', &
                'tension of upper body', 'cycle dissipation', 'tangential stiffness', 'secant stiffness', 'loss factor', 'moment', &
                                                       'rotation', 'creepage', 'worn area', 'wear depth']
      type(field_type), allocatable :: fields(:)
      character(:), allocatable :: meshes, value, percent
      integer :: i, first

      if (simulation%estimate%message /= '') then
         call add_line(text, 'error estimate', 'none: '//simulation%estimate%message)
         return
      end if
      call group_fields(case, simulation, 'error_estimate', fields)
      first = 1
      if (.not. shows_extremes(seen, simulation)) first = extremes + 1
      do i = first, size(names)
         associate (bar => simulation%estimate%bar(observable_place(trim(names(i)))))
            if (.not. bar%known) cycle
            ! Several patches have a total length but no half-width.
            if (names(i) == 'contact_length' .and. field_named(fields, 'contact_half_width') > 0) cycle
            value = trim(words(i))//' '//amount(fields, trim(names(i)))
            percent = ''
            if (abs(bar%value) > 0.0_wp) percent = ' ('//to_text(100.0_wp*bar%error/abs(bar%value), 2)//' %)'
            if (.not. bar%resolved) then
               call add_line(text, 'error estimate', value//' is not resolved: see the warning')
            else if (ieee_is_finite(bar%error)) then
               call add_line(text, 'error estimate', value//' +- '//to_text(bar%error, 2)//percent//', order '// &
                             to_text(bar%order, 2))
            else if (.not. bar%order < 0.0_wp) then
               call add_line(text, 'error estimate', value//' grows with the logarithm of the nodes: it has no limit')
            else
               call add_line(text, 'error estimate', value//' grows as nodes^'//to_text(-bar%order, 2)// &
                             ' with every finer mesh: it has no limit')
            end if
         end associate
      end do
      meshes = to_text(simulation%estimate%coarser_nodes(1))
      do i = 2, size(simulation%estimate%coarser_nodes)
         meshes = meshes//', '//to_text(simulation%estimate%coarser_nodes(i))
      end do
      call add_line(text, 'error estimate', 'from meshes with '//meshes//' nodes in place of '// &
                    to_text(simulation%estimate%nodes))
   end subroutine add_estimate

   !> A number of things: 1 event, 2 events; padded with blanks.
   pure function numbered(number, name) result(text)
      integer, intent(in) :: number
      character(*), intent(in) :: name
      character(len=60) :: text

      text = to_text(number)//' '//name//merge('s', ' ', number /= 1)
   end function numbered

   !> Changes in a second run with perturbed friction, or why there are none.
   subroutine add_sensitivity(text, simulation)
      character(:), allocatable, intent(inout) :: text
      type(simulation_type), intent(in) :: simulation

      associate (s => simulation%sensitivity)
         if (s%message /= '') then
            call add_line(text, 'sensitivity', 'none: '//s%message)
            return
         end if
         call add_line(text, 'sensitivity', 'coefficients of friction times 1 + '//to_text(s%perturbation, 1)// &
                       ' change pressures by '//to_text(s%pressure, 1)//' and shear by '//to_text(s%shear, 1)// &
                       ' of the largest traction,')
         call add_line(text, 'sensitivity', 'dissipation by '//to_text(s%dissipation, 1)//' (relative), the stick ratio by '// &
                       to_text(s%stick_ratio, 1))
         if (max(s%pressure, s%shear, s%dissipation, s%stick_ratio) > visible) &
            call add_line(text, 'sensitivity', 'this result depends on round-off: do not quote it more precisely than these '// &
                          'changes')
      end associate
   end subroutine add_sensitivity

   !> Summary of a valid case.
   subroutine summarize_check(case, text)
      type(case_type), intent(in) :: case
      character(:), allocatable, intent(out) :: text
      type(contact_model_type) :: model

      model = new_contact_model(case%scene)
      text = ''
      call add_line(text, 'case', case%source//' is valid')
      call add_line(text, 'title', case%scene%title)
      call add_compliance(text, model)
      call add_line(text, 'mesh', to_text(model%nodes())//' nodes over |x| < '//to_text(model%length())// &
                    trim(merge(', growing', '         ', model%growing)))
      call add_line(text, 'steps', to_text(size(case%scene%steps)))
      if (case%result_path /= '') call add_line(text, 'result', case%result_path)
   end subroutine summarize_check

   !> Append a line: a label, padded, and a value.
   subroutine add_line(text, label, value)
      character(:), allocatable, intent(inout) :: text
      character(*), intent(in) :: label, value
      character(len=20) :: padded

      padded = label
      text = text//padded//value//line_feed
   end subroutine add_line

   !> The value of a field, with the user's unit if it has one.
   pure function amount(fields, name) result(text)
      type(field_type), intent(in) :: fields(:)
      character(*), intent(in) :: name
      character(len=length_of_amount(fields, name)) :: text
      character(:), allocatable :: words

      call find_amount(fields, name, words)
      text = words
   end function amount

   !> Length of such a value.
   pure integer function length_of_amount(fields, name) result(length)
      type(field_type), intent(in) :: fields(:)
      character(*), intent(in) :: name
      character(:), allocatable :: words

      call find_amount(fields, name, words)
      length = len(words)
   end function length_of_amount

   !> The same as an allocatable; empty if there is no such field.
   pure subroutine find_amount(fields, name, text)
      type(field_type), intent(in) :: fields(:)
      character(*), intent(in) :: name
      character(:), allocatable, intent(out) :: text
      integer :: i

      text = ''
      i = field_named(fields, name)
      if (i == 0) return
      if (allocated(fields(i)%whole)) then
         text = to_text(fields(i)%whole(1))//unit_suffix(fields(i)%unit)
      else
         text = to_text(fields(i)%values(1))//unit_suffix(fields(i)%unit)
      end if
   end subroutine find_amount

   !> A unit after a value: empty unless the user has named the units.
   pure function unit_suffix(unit) result(suffix)
      character(*), intent(in) :: unit
      character(len=merge(len(unit) + 1, 0, is_named(unit))) :: suffix

      suffix = ' '//unit
   end function unit_suffix

   !> Whether the user has named the units.
   pure logical function is_named(unit)
      character(*), intent(in) :: unit

      is_named = unit /= '1' .and. index(unit, 'length') == 0 .and. index(unit, 'force') == 0
   end function is_named

end module mfv_summary
