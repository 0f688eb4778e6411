!> The one list of groups and keys of a sweep (see mfv_keys). The reader checks against it, the reference in docs/sweep.md and
!> `mfv_sweep --keys` are printed from it.
module mfv_sweep_keys
   use mfv_keys
   use mfv_kinds, only: wp
   implicit none
   private
   public :: sweep_catalogue

   !> Values that one axis can have.
   real(wp), parameter :: most_values = 1.0e5_wp

contains

   !> All keys.
   function sweep_catalogue() result(catalogue)
      type(catalogue_type) :: catalogue

      catalogue%group_list = 'sweep vary'
      catalogue%repeated_groups = 'vary'
      allocate (catalogue%keys(0))
      call add_sweep_keys(catalogue%keys)
      call add_vary_keys(catalogue%keys)
   end function sweep_catalogue

   subroutine add_sweep_keys(keys)
      type(key_type), allocatable, intent(inout) :: keys(:)

      call add_text_key(keys, 'sweep', 'base', '', 'case file, or several of them, that the values are put into; beside '// &
                        'the sweep file; needed')
      keys(size(keys))%is_list = .true.
      call add_text_key(keys, 'sweep', 'file', '', 'file of the table (HDF5); if omitted: the name of the sweep file with '// &
                        '.h5, in the working directory')
      call add_choice_key(keys, 'sweep', 'combine', 'all', 'all paired', 'all combinations of the values, those of the '// &
                          'last &vary fastest; or paired: the first of each, the second of each, ...')
      call add_choice_key(keys, 'sweep', 'states', 'none', 'none all', 'all: the whole result of every case is kept too, '// &
                          'in the folder of the table with .cases in place of .h5')
      call add_choice_key(keys, 'sweep', 'reference', 'none', 'none full', 'full: every case is compared with the one of '// &
                          'full coupling that is the same otherwise; needs a &vary of scene%coupling with that value')
   end subroutine add_sweep_keys

   subroutine add_vary_keys(keys)
      type(key_type), allocatable, intent(inout) :: keys(:)

      call add_text_key(keys, 'vary', 'key', '', "key of the case, such as 'friction%mu' or 'step(2)%normal_force', or "// &
                        "several that move together; 'dundurs_beta': the materials of both bodies; needed")
      keys(size(keys))%is_list = .true.
      call add_real_key(keys, 'vary', 'factor', '', 'what the value is multiplied by, one for each key; if omitted: 1')
      keys(size(keys))%is_list = .true.
      call add_key(keys, 'vary', 'values', kind_any, '', '', 'the values, in the unit of the key')
      keys(size(keys))%is_list = .true.
      call add_real_key(keys, 'vary', 'from', '', 'in place of values: the first of a row of numbers')
      call add_real_key(keys, 'vary', 'to', '', 'its last')
      call add_integer_key(keys, 'vary', 'count', '', 'how many there are', 1.0_wp, most_values)
      call add_choice_key(keys, 'vary', 'spacing', 'linear', 'linear log', 'whether neighbours have the same distance '// &
                          'or the same ratio')
      call add_text_key(keys, 'vary', 'name', '', 'name of the column in the table; if omitted: the first key as written')
   end subroutine add_vary_keys

end module mfv_sweep_keys
