!> Roots and quadrature by GSL, for plain procedures with an array of parameters.
module mfv_numerics
   use, intrinsic :: iso_c_binding, only: c_double, c_f_pointer, c_funloc, c_int, c_loc, c_ptr
   use mfv_gsl
   use mfv_kinds, only: wp
   use mfv_quadrature, only: gauss_points
   implicit none
   private
   public :: root_between, gauss_legendre

   abstract interface
      !> A real function of one variable `x` and parameters.
      function parametric_function(x, parameters) result(value)
         import :: wp
         real(wp), intent(in) :: x, parameters(:)
         real(wp) :: value
      end function parametric_function
   end interface

   !> Parameter of the GSL callback.
   type :: integrand_context_type
      procedure(parametric_function), pointer, nopass :: f
      real(wp), allocatable :: parameters(:)
   end type integrand_context_type

contains

   !> Root of `f(x, parameters)` between `lower` and `upper`, by Brent's method, to machine precision. Without a change of
   !> sign, the end nearer to a root (no error).
   function root_between(f, parameters, lower, upper) result(root)
      procedure(parametric_function) :: f
      real(wp), intent(in) :: parameters(:), lower, upper
      real(wp) :: root
      integer, parameter :: most_iterations = 200
      type(integrand_context_type), target :: context
      type(gsl_function) :: gsl_f
      type(c_ptr) :: solver
      real(wp) :: at_lower, at_upper, previous
      integer(c_int) :: code
      integer :: iteration

      at_lower = f(lower, parameters)
      at_upper = f(upper, parameters)
      root = merge(lower, upper, abs(at_lower) < abs(at_upper))
      if (.not. at_lower*at_upper < 0.0_wp) return

      context%f => f
      context%parameters = parameters
      gsl_f%function = c_funloc(evaluate)
      gsl_f%params = c_loc(context)
      solver = gsl_root_fsolver_alloc(gsl_root_fsolver_brent)
      code = gsl_root_fsolver_set(solver, gsl_f, lower, upper)
      previous = huge(previous)
      do iteration = 1, most_iterations
         code = gsl_root_fsolver_iterate(solver)
         root = gsl_root_fsolver_root(solver)
         if (abs(root - previous) <= 2*epsilon(root)*abs(root)) exit
         previous = root
      end do
      call gsl_root_fsolver_free(solver)
   end function root_between

   !> Integral of `f(x, parameters)` from `lower` to `upper` with `points` Gauss-Legendre points.
   function gauss_legendre(f, parameters, lower, upper, points) result(integral)
      procedure(parametric_function) :: f
      real(wp), intent(in) :: parameters(:), lower, upper
      integer, intent(in) :: points
      real(wp) :: integral, x(points), weight(points)
      integer :: i

      call gauss_points(lower, upper, x, weight)
      integral = 0.0_wp
      do i = 1, points
         integral = integral + weight(i)*f(x(i), parameters)
      end do
   end function gauss_legendre

   !> Callback of GSL: a module procedure, which needs no executable stack.
   function evaluate(x, params) result(value) bind(C, name='')
      real(c_double), value :: x
      type(c_ptr), value :: params
      real(c_double) :: value
      type(integrand_context_type), pointer :: context

      call c_f_pointer(params, context)
      value = context%f(x, context%parameters)
   end function evaluate

end module mfv_numerics
