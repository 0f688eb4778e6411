!> Minimum of a function of several variables, by GSL's simplex search (Nelder and Mead).
module mfv_minimum
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use, intrinsic :: iso_c_binding, only: c_double, c_f_pointer, c_funloc, c_loc, c_ptr, c_size_t
   use mfv_gsl
   use mfv_kinds, only: wp
   implicit none
   private
   public :: minimum_near, objective_type

   !> An objective function and its data.
   type, abstract :: objective_type
   contains
      procedure(value_interface), deferred :: value
   end type objective_type

   abstract interface
      !> Value at `x`.
      function value_interface(self, x) result(value)
         import :: objective_type, wp
         class(objective_type), intent(in) :: self
         real(wp), intent(in) :: x(:)
         real(wp) :: value
      end function value_interface
   end interface

   !> Parameter of the GSL callback.
   type :: objective_context_type
      class(objective_type), pointer :: objective
      integer :: variables = 0
   end type objective_context_type

contains

   !> Local minimum of an objective near `x`, with initial steps `step`, shape of x; stops at 1e-5 of the initial simplex size
   !> (a smooth objective is then known to some 1e-10 of its change over that) or after 400 iterations. Returns the point in `x` and
   !> the objective in `value`.
   subroutine minimum_near(objective, step, x, value)
      class(objective_type), intent(in), target :: objective
      real(wp), intent(in) :: step(:)
      real(wp), intent(inout) :: x(:)
      real(wp), intent(out) :: value
      integer, parameter :: most_iterations = 400
      real(wp), parameter :: smallest = 1.0e-5_wp
      type(objective_context_type), target :: context
      type(gsl_multimin_function) :: gsl_f
      type(c_ptr) :: solver, start, steps
      real(wp) :: first_size
      integer :: iteration

      context%objective => objective
      context%variables = size(x)
      gsl_f = gsl_multimin_function(c_funloc(evaluate_objective), size(x, kind=c_size_t), c_loc(context))
      start = vector_of(x)
      steps = vector_of(step)
      solver = gsl_multimin_fminimizer_alloc(gsl_multimin_fminimizer_nmsimplex2, size(x, kind=c_size_t))
      if (gsl_multimin_fminimizer_set(solver, gsl_f, start, steps) == 0) then
         first_size = gsl_multimin_fminimizer_size(solver)
         do iteration = 1, most_iterations
            if (gsl_multimin_fminimizer_iterate(solver) /= 0) exit
            if (gsl_multimin_fminimizer_size(solver) < smallest*first_size) exit
         end do
         x = values_of(gsl_multimin_fminimizer_x(solver), size(x))
      end if
      value = objective%value(x)
      call gsl_multimin_fminimizer_free(solver)
      call gsl_vector_free(start)
      call gsl_vector_free(steps)
   end subroutine minimum_near

   function vector_of(values) result(vector)
      real(wp), intent(in) :: values(:)
      type(c_ptr) :: vector
      integer :: i

      vector = gsl_vector_alloc(size(values, kind=c_size_t))
      do i = 1, size(values)
         call gsl_vector_set(vector, int(i - 1, c_size_t), values(i))
      end do
   end function vector_of

   function values_of(vector, n) result(values)
      type(c_ptr), intent(in) :: vector
      integer, intent(in) :: n
      real(wp) :: values(n)
      integer :: i

      do i = 1, n
         values(i) = gsl_vector_get(vector, int(i - 1, c_size_t))
      end do
   end function values_of

   !> Callback of GSL, which aborts the process if a value is not finite.
   function evaluate_objective(x, params) result(value) bind(C, name='')
      type(c_ptr), value :: x, params
      real(c_double) :: value
      type(objective_context_type), pointer :: context

      call c_f_pointer(params, context)
      value = context%objective%value(values_of(x, context%variables))
      if (.not. ieee_is_finite(value)) value = huge(value)
   end function evaluate_objective

end module mfv_minimum
