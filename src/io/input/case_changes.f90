!> Changes to the groups of a case: a value in place of another, and materials for a value of Dundurs' parameter.
module mfv_case_changes
   use mfv_kinds, only: wp
   use mfv_namelist, only: append_entry, append_group, entry_type, group_type, place_of_group
   use mfv_numbers, only: read_real
   use mfv_strings, only: to_text
   implicit none
   private
   public :: put_entry, remove_alternatives, remove_keys, set_dundurs_beta, write_number

   !> Keys of one group of which a case has one at most: a value for one takes the place of the others.
   character(*), parameter :: alternatives(5) = [character(40) :: 'tangential_force force_ratio shift', &
                                                 'normal_force approach', 'moment rotation', &
                                                 'shear_modulus youngs_modulus', 'half_width half_angle']

contains

   !> Put a value, as it would be written, into a key of the `number`-th group of a name; key and group are added where they are
   !> not there.
   subroutine set_value(groups, group, number, key, value, is_quoted)
      type(group_type), allocatable, intent(inout) :: groups(:)
      character(*), intent(in) :: group, key, value
      integer, intent(in) :: number
      logical, intent(in) :: is_quoted
      type(entry_type) :: entry

      entry%key = key
      allocate (entry%values(1))
      entry%values(1)%text = value
      entry%is_quoted = [is_quoted]
      call put_entry(groups, group, number, entry)
   end subroutine set_value

   !> The same with a whole entry, whose line becomes that of what it takes the place of.
   subroutine put_entry(groups, group, number, entry)
      type(group_type), allocatable, intent(inout) :: groups(:)
      character(*), intent(in) :: group
      integer, intent(in) :: number
      type(entry_type), intent(inout) :: entry
      type(group_type) :: new
      integer :: place, i

      place = place_of_group(groups, group, number)
      if (place == 0) then
         new%name = group
         allocate (new%entries(0))
         call append_group(groups, new)
         place = size(groups)
      end if
      entry%line = groups(place)%line
      do i = 1, size(groups(place)%entries)
         if (groups(place)%entries(i)%key /= entry%key) cycle
         entry%line = groups(place)%entries(i)%line
         groups(place)%entries(i) = entry
         return
      end do
      call append_entry(groups(place)%entries, entry)
   end subroutine put_entry

   !> Take out the keys of the `number`-th group of a name whose place a key takes, itself among them.
   subroutine remove_alternatives(groups, group, number, key)
      type(group_type), intent(inout) :: groups(:)
      character(*), intent(in) :: group, key
      integer, intent(in) :: number
      integer :: i

      call remove_keys(groups, group, number, key)
      do i = 1, size(alternatives)
         if (index(' '//alternatives(i), ' '//key//' ') > 0) call remove_keys(groups, group, number, trim(alternatives(i)))
      end do
   end subroutine remove_alternatives

   !> Give both bodies materials with Dundurs' parameter `beta`, from -1/2 to 1/2, positive where the lower body couples more,
   !> and the mutual compliance A, length^2/force, the sum of (kappa + 1)/(4 G): Poisson's ratio 0, that is kappa = 3 in plane
   !> strain and plane stress, 1/G_1 = A (1 + 2 beta)/2 and 1/G_2 = A (1 - 2 beta)/2 (dissertation eq. 6.1). A body without flexibility
   !> becomes rigid.
   subroutine set_dundurs_beta(groups, beta, compliance)
      type(group_type), allocatable, intent(inout) :: groups(:)
      real(wp), intent(in) :: beta, compliance
      character(:), allocatable :: modulus
      real(wp) :: flexibility(2)
      integer :: body

      flexibility = 0.5_wp*compliance*[1.0_wp + 2.0_wp*beta, 1.0_wp - 2.0_wp*beta]
      do body = 1, 2
         call remove_keys(groups, 'body', body, 'shear_modulus youngs_modulus poisson_ratio rigid')
         if (flexibility(body) > 0.0_wp) then
            call write_number(1.0_wp/flexibility(body), modulus)
            call set_value(groups, 'body', body, 'shear_modulus', modulus, .false.)
            call set_value(groups, 'body', body, 'poisson_ratio', '0', .false.)
         else
            call remove_keys(groups, 'body', body, 'yield_strength datum kernel harmonics')
            call set_value(groups, 'body', body, 'rigid', '.true.', .false.)
         end if
      end do
   end subroutine set_dundurs_beta

   !> Take keys, separated by blanks, out of the `number`-th group of a name.
   subroutine remove_keys(groups, group, number, keys)
      type(group_type), intent(inout) :: groups(:)
      character(*), intent(in) :: group, keys
      integer, intent(in) :: number
      type(entry_type), allocatable :: old(:), left(:)
      integer :: place, i

      place = place_of_group(groups, group, number)
      if (place == 0) return
      call move_alloc(groups(place)%entries, old)
      allocate (left(0))
      do i = 1, size(old)
         if (index(' '//keys//' ', ' '//old(i)%key//' ') == 0) call append_entry(left, old(i))
      end do
      call move_alloc(left, groups(place)%entries)
   end subroutine remove_keys

   !> The shortest text that is read as this number.
   pure subroutine write_number(value, text)
      real(wp), intent(in) :: value
      character(:), allocatable, intent(out) :: text

      text = to_text(value, digits_needed(value))
   end subroutine write_number

   !> How many significant digits tell a number from its neighbours, or 15 where fewer do: these end with zeros, which to_text leaves
   !> out.
   pure integer function digits_needed(value) result(digits)
      real(wp), intent(in) :: value
      integer, parameter :: enough = 17
      character(len=48) :: text
      real(wp) :: again
      logical :: is_right

      do digits = precision(value), enough - 1
         text = to_text(value, digits)
         call read_real(trim(text), again, is_right)
         if (.not. is_right) cycle
         if (.not. abs(again - value) > 0.0_wp) return
      end do
   end function digits_needed

end module mfv_case_changes
