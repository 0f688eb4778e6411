!> Objects as bytes, to go on from another day. Every type that is carried has one procedure `carry` that goes both ways: it names
!> what the object is made of, and the archive either takes it in or gives it back. So writing and reading cannot come apart.
!>
!> The bytes are those of the memory: they are of use to the same build on the same sort of machine.
module mfv_archive
   use, intrinsic :: iso_c_binding, only: c_f_pointer, c_loc
   use, intrinsic :: iso_fortran_env, only: int64, int8
   use mfv_kinds, only: wp
   implicit none
   private
   public :: archive_type, new_archive

   type :: archive_type
      private
      !> The image: the first `done` bytes have been carried.
      integer(int8), allocatable :: image(:)
      integer(int64) :: done = 0
      logical :: reading = .false.
      !> What is to be read is not in the image.
      logical :: damaged = .false.
   contains
      procedure :: is_reading
      procedure :: is_damaged
      procedure :: is_at_end
      procedure :: take_bytes
      procedure :: carries
      !> Scalars; and allocatable texts and arrays, allocated or not, with their shapes.
      generic :: carry => carry_integer, carry_long, carry_real, carry_logical, carry_text, carry_integers, carry_integer_table, &
                          carry_reals, carry_real_table, carry_logicals
      !> Arrays whose shape is known.
      generic :: fill => fill_integers, fill_reals, fill_logicals, fill_text
      procedure, private :: carry_integer, carry_long, carry_real, carry_logical, carry_text, carry_integers, carry_integer_table, &
                            carry_reals, carry_real_table, carry_logicals
      procedure, private :: fill_integers, fill_reals, fill_logicals, fill_text
      procedure, private :: carry_extents, pass, pass_integers, pass_reals
   end type archive_type

   integer, parameter :: byte_bits = 8

contains

   !> An empty archive to write to, or one to read `image` from.
   subroutine new_archive(archive, image)
      type(archive_type), intent(out) :: archive
      integer(int8), intent(in), optional :: image(:)
      integer, parameter :: first_capacity = 4096

      archive%reading = present(image)
      if (present(image)) then
         archive%image = image
      else
         allocate (archive%image(first_capacity))
      end if
   end subroutine new_archive

   pure logical function is_reading(self)
      class(archive_type), intent(in) :: self

      is_reading = self%reading
   end function is_reading

   !> Whether something was to be read that is not there; what was read since is of no use.
   pure logical function is_damaged(self)
      class(archive_type), intent(in) :: self

      is_damaged = self%damaged
   end function is_damaged

   !> Whether all has been read.
   pure logical function is_at_end(self)
      class(archive_type), intent(in) :: self

      is_at_end = self%done == size(self%image, kind=int64)
   end function is_at_end

   !> What has been written.
   subroutine take_bytes(self, bytes)
      class(archive_type), intent(in) :: self
      integer(int8), allocatable, intent(out) :: bytes(:)

      bytes = self%image(:self%done)
   end subroutine take_bytes

   !> Whether there is an object: `here` where it is written, and what was written where it is read.
   logical function carries(self, here)
      class(archive_type), intent(inout) :: self
      logical, intent(in) :: here

      carries = here
      call self%carry(carries)
   end function carries

   subroutine carry_integer(self, value)
      class(archive_type), intent(inout) :: self
      integer, intent(inout) :: value
      integer :: values(1)

      values = value
      call self%pass_integers(values, 1_int64)
      value = values(1)
   end subroutine carry_integer

   subroutine carry_long(self, value)
      class(archive_type), intent(inout) :: self
      integer(int64), intent(inout), target :: value
      integer(int8), pointer :: bytes(:)

      call c_f_pointer(c_loc(value), bytes, [storage_size(value)/byte_bits])
      call self%pass(bytes)
   end subroutine carry_long

   subroutine carry_real(self, value)
      class(archive_type), intent(inout) :: self
      real(wp), intent(inout) :: value
      real(wp) :: values(1)

      values = value
      call self%pass_reals(values, 1_int64)
      value = values(1)
   end subroutine carry_real

   subroutine carry_logical(self, value)
      class(archive_type), intent(inout) :: self
      logical, intent(inout) :: value
      integer :: one_if_true

      one_if_true = 0
      if (.not. self%reading) one_if_true = merge(1, 0, value)
      call self%carry(one_if_true)
      value = one_if_true == 1
   end subroutine carry_logical

   subroutine carry_text(self, text)
      class(archive_type), intent(inout) :: self
      character(:), allocatable, intent(inout) :: text
      integer(int64) :: extent(1)
      logical :: is_there

      is_there = allocated(text)
      extent = 0
      if (is_there) extent = len(text)
      call self%carry_extents(is_there, extent, 1)
      if (self%reading) then
         if (allocated(text)) deallocate (text)
         if (is_there) allocate (character(len=extent(1)) :: text)
      end if
      if (is_there) call self%fill(text)
   end subroutine carry_text

   subroutine carry_integers(self, values)
      class(archive_type), intent(inout) :: self
      integer, allocatable, intent(inout) :: values(:)
      integer(int64) :: extents(1)
      logical :: is_there

      is_there = allocated(values)
      extents = 0
      if (is_there) extents = shape(values, kind=int64)
      call self%carry_extents(is_there, extents, storage_size(values)/byte_bits)
      if (self%reading) then
         if (allocated(values)) deallocate (values)
         if (is_there) allocate (values(extents(1)))
      end if
      if (is_there) call self%pass_integers(values, extents(1))
   end subroutine carry_integers

   subroutine carry_integer_table(self, values)
      class(archive_type), intent(inout) :: self
      integer, allocatable, intent(inout) :: values(:, :)
      integer(int64) :: extents(2)
      logical :: is_there

      is_there = allocated(values)
      extents = 0
      if (is_there) extents = shape(values, kind=int64)
      call self%carry_extents(is_there, extents, storage_size(values)/byte_bits)
      if (self%reading) then
         if (allocated(values)) deallocate (values)
         if (is_there) allocate (values(extents(1), extents(2)))
      end if
      if (is_there) call self%pass_integers(values, product(extents))
   end subroutine carry_integer_table

   subroutine carry_reals(self, values)
      class(archive_type), intent(inout) :: self
      real(wp), allocatable, intent(inout) :: values(:)
      integer(int64) :: extents(1)
      logical :: is_there

      is_there = allocated(values)
      extents = 0
      if (is_there) extents = shape(values, kind=int64)
      call self%carry_extents(is_there, extents, storage_size(values)/byte_bits)
      if (self%reading) then
         if (allocated(values)) deallocate (values)
         if (is_there) allocate (values(extents(1)))
      end if
      if (is_there) call self%pass_reals(values, extents(1))
   end subroutine carry_reals

   subroutine carry_real_table(self, values)
      class(archive_type), intent(inout) :: self
      real(wp), allocatable, intent(inout) :: values(:, :)
      integer(int64) :: extents(2)
      logical :: is_there

      is_there = allocated(values)
      extents = 0
      if (is_there) extents = shape(values, kind=int64)
      call self%carry_extents(is_there, extents, storage_size(values)/byte_bits)
      if (self%reading) then
         if (allocated(values)) deallocate (values)
         if (is_there) allocate (values(extents(1), extents(2)))
      end if
      if (is_there) call self%pass_reals(values, product(extents))
   end subroutine carry_real_table

   subroutine carry_logicals(self, values)
      class(archive_type), intent(inout) :: self
      logical, allocatable, intent(inout) :: values(:)
      integer, allocatable :: ones(:)

      if (allocated(values) .and. .not. self%reading) ones = merge(1, 0, values)
      call self%carry(ones)
      if (.not. self%reading) return
      if (allocated(values)) deallocate (values)
      if (allocated(ones)) values = ones == 1
   end subroutine carry_logicals

   subroutine fill_integers(self, values)
      class(archive_type), intent(inout) :: self
      integer, intent(inout) :: values(:)

      call self%pass_integers(values, size(values, kind=int64))
   end subroutine fill_integers

   subroutine fill_reals(self, values)
      class(archive_type), intent(inout) :: self
      real(wp), intent(inout) :: values(:)

      call self%pass_reals(values, size(values, kind=int64))
   end subroutine fill_reals

   subroutine fill_logicals(self, values)
      class(archive_type), intent(inout) :: self
      logical, intent(inout) :: values(:)
      integer :: ones(size(values))

      ones = 0
      if (.not. self%reading) ones = merge(1, 0, values)
      call self%fill(ones)
      values = ones == 1
   end subroutine fill_logicals

   subroutine fill_text(self, text)
      class(archive_type), intent(inout) :: self
      character(*), intent(inout) :: text
      integer(int8) :: bytes(len(text))

      if (.not. self%reading) bytes = transfer(text, bytes)
      call self%pass(bytes)
      if (self%reading) text = transfer(bytes, text)
   end subroutine fill_text

   !> Whether an array is there, and its extents. One that cannot be in what is left of the image is not: the archive is damaged.
   subroutine carry_extents(self, is_there, extents, element_bytes)
      class(archive_type), intent(inout) :: self
      logical, intent(inout) :: is_there
      integer(int64), intent(inout) :: extents(:)
      integer, intent(in) :: element_bytes
      integer(int64) :: left
      integer :: i

      call self%carry(is_there)
      if (.not. is_there) return
      do i = 1, size(extents)
         call self%carry(extents(i))
      end do
      if (.not. self%reading) return
      left = (size(self%image, kind=int64) - self%done)/element_bytes
      do i = 1, size(extents)
         if (extents(i) < 0 .or. extents(i) > left) self%damaged = .true.
         if (extents(i) > 0) left = left/extents(i)
      end do
      is_there = is_there .and. .not. self%damaged
   end subroutine carry_extents

   subroutine pass_integers(self, values, number)
      class(archive_type), intent(inout) :: self
      integer(int64), intent(in) :: number
      integer, intent(inout), target :: values(number)
      integer(int8), pointer :: bytes(:)

      if (number == 0) return
      call c_f_pointer(c_loc(values), bytes, [number*(storage_size(values)/byte_bits)])
      call self%pass(bytes)
   end subroutine pass_integers

   subroutine pass_reals(self, values, number)
      class(archive_type), intent(inout) :: self
      integer(int64), intent(in) :: number
      real(wp), intent(inout), target :: values(number)
      integer(int8), pointer :: bytes(:)

      if (number == 0) return
      call c_f_pointer(c_loc(values), bytes, [number*(storage_size(values)/byte_bits)])
      call self%pass(bytes)
   end subroutine pass_reals

   !> Take in bytes, or give them back.
   subroutine pass(self, bytes)
      class(archive_type), intent(inout) :: self
      integer(int8), intent(inout) :: bytes(:)
      integer(int8), allocatable :: longer(:)
      integer(int64) :: total

      total = self%done + size(bytes, kind=int64)
      if (self%reading) then
         self%damaged = self%damaged .or. total > size(self%image, kind=int64)
         if (self%damaged) return
         bytes = self%image(self%done + 1:total)
      else
         if (total > size(self%image, kind=int64)) then
            allocate (longer(max(total, 2*size(self%image, kind=int64))))
            longer(:self%done) = self%image(:self%done)
            call move_alloc(longer, self%image)
         end if
         self%image(self%done + 1:total) = bytes
      end if
      self%done = total
   end subroutine pass

end module mfv_archive
