!> Bindings to the parts of the GNU Scientific Library that the project uses.
!>
!> GSL's default error handler aborts the process and replacing it would change the state of a host program, so
!> every caller in this project stays inside the domain in which these functions cannot fail.
module mfv_gsl
   use, intrinsic :: iso_c_binding, only: c_double, c_int, c_ptr, c_funptr, c_size_t
   implicit none
   private :: c_double, c_int, c_ptr, c_funptr, c_size_t

   !> Precision mode of the elliptic integrals: full double precision.
   integer(c_int), parameter :: GSL_PREC_DOUBLE = 0

   !> A function of one variable with its parameters, as GSL's solvers take it.
   type, bind(C) :: gsl_function
      type(c_funptr) :: function
      type(c_ptr) :: params
   end type gsl_function

   !> A function of several variables with its parameters.
   type, bind(C) :: gsl_multimin_function
      type(c_funptr) :: f
      integer(c_size_t) :: n
      type(c_ptr) :: params
   end type gsl_multimin_function

   !> Brent's bracketing root solver, linear and Steffen's monotone cubic interpolation, Nelder and Mead's simplex search: constants of
   !> GSL. They must be public here, or the linker would take them for variables of our own.
   type(c_ptr), protected, bind(C, name='gsl_root_fsolver_brent') :: gsl_root_fsolver_brent
   type(c_ptr), protected, bind(C, name='gsl_interp_linear') :: gsl_interp_linear
   type(c_ptr), protected, bind(C, name='gsl_interp_steffen') :: gsl_interp_steffen
   type(c_ptr), protected, bind(C, name='gsl_multimin_fminimizer_nmsimplex2') :: gsl_multimin_fminimizer_nmsimplex2

   abstract interface
      function make_solver(kind) bind(C)
         import :: c_ptr
         type(c_ptr), value :: kind
         type(c_ptr) :: make_solver
      end function make_solver

      function make_of_kind(kind, n) bind(C)
         import :: c_ptr, c_size_t
         type(c_ptr), value :: kind
         integer(c_size_t), value :: n
         type(c_ptr) :: make_of_kind
      end function make_of_kind

      function make_of_size(n) bind(C)
         import :: c_ptr, c_size_t
         integer(c_size_t), value :: n
         type(c_ptr) :: make_of_size
      end function make_of_size

      subroutine free_object(object) bind(C)
         import :: c_ptr
         type(c_ptr), value :: object
      end subroutine free_object

      function iterate(solver) bind(C)
         import :: c_int, c_ptr
         type(c_ptr), value :: solver
         integer(c_int) :: iterate
      end function iterate

      function number_of(solver) bind(C)
         import :: c_double, c_ptr
         type(c_ptr), value :: solver
         real(c_double) :: number_of
      end function number_of
   end interface

   !> Points and weights of Gauss-Legendre quadrature.
   procedure(make_of_size), bind(C, name='gsl_integration_glfixed_table_alloc') :: gsl_integration_glfixed_table_alloc
   procedure(free_object), bind(C, name='gsl_integration_glfixed_table_free') :: gsl_integration_glfixed_table_free
   procedure(make_solver), bind(C, name='gsl_root_fsolver_alloc') :: gsl_root_fsolver_alloc
   procedure(iterate), bind(C, name='gsl_root_fsolver_iterate') :: gsl_root_fsolver_iterate
   procedure(number_of), bind(C, name='gsl_root_fsolver_root') :: gsl_root_fsolver_root
   procedure(free_object), bind(C, name='gsl_root_fsolver_free') :: gsl_root_fsolver_free
   procedure(make_of_kind), bind(C, name='gsl_interp_alloc') :: gsl_interp_alloc
   procedure(free_object), bind(C, name='gsl_interp_free') :: gsl_interp_free
   procedure(make_of_kind), bind(C, name='gsl_multimin_fminimizer_alloc') :: gsl_multimin_fminimizer_alloc
   procedure(iterate), bind(C, name='gsl_multimin_fminimizer_iterate') :: gsl_multimin_fminimizer_iterate
   procedure(number_of), bind(C, name='gsl_multimin_fminimizer_size') :: gsl_multimin_fminimizer_size
   procedure(free_object), bind(C, name='gsl_multimin_fminimizer_free') :: gsl_multimin_fminimizer_free
   procedure(make_of_size), bind(C, name='gsl_vector_alloc') :: gsl_vector_alloc
   procedure(free_object), bind(C, name='gsl_vector_free') :: gsl_vector_free

   interface
      !> Carlson's symmetric elliptic integral of the first kind.
      pure function gsl_sf_ellint_RF(x, y, z, mode) bind(C, name='gsl_sf_ellint_RF')
         import :: c_double, c_int
         real(c_double), value :: x, y, z
         integer(c_int), value :: mode
         real(c_double) :: gsl_sf_ellint_RF
      end function gsl_sf_ellint_RF

      function gsl_integration_glfixed_point(a, b, i, x, weight, table) bind(C, name='gsl_integration_glfixed_point')
         import :: c_double, c_int, c_ptr, c_size_t
         real(c_double), value :: a, b
         integer(c_size_t), value :: i
         real(c_double), intent(out) :: x, weight
         type(c_ptr), value :: table
         integer(c_int) :: gsl_integration_glfixed_point
      end function gsl_integration_glfixed_point

      function gsl_root_fsolver_set(solver, f, lower, upper) bind(C, name='gsl_root_fsolver_set')
         import :: c_double, c_int, c_ptr, gsl_function
         type(c_ptr), value :: solver
         type(gsl_function), intent(in) :: f
         real(c_double), value :: lower, upper
         integer(c_int) :: gsl_root_fsolver_set
      end function gsl_root_fsolver_set

      function gsl_interp_init(interpolation, x, y, n) bind(C, name='gsl_interp_init')
         import :: c_double, c_int, c_ptr, c_size_t
         type(c_ptr), value :: interpolation
         real(c_double), intent(in) :: x(*), y(*)
         integer(c_size_t), value :: n
         integer(c_int) :: gsl_interp_init
      end function gsl_interp_init

      function gsl_interp_eval(interpolation, x, y, at, accelerator) bind(C, name='gsl_interp_eval')
         import :: c_double, c_ptr
         type(c_ptr), value :: interpolation, accelerator
         real(c_double), intent(in) :: x(*), y(*)
         real(c_double), value :: at
         real(c_double) :: gsl_interp_eval
      end function gsl_interp_eval

      function gsl_multimin_fminimizer_set(solver, f, x, step) bind(C, name='gsl_multimin_fminimizer_set') result(code)
         import :: c_int, c_ptr, gsl_multimin_function
         type(c_ptr), value :: solver, x, step
         type(gsl_multimin_function), intent(in) :: f
         integer(c_int) :: code
      end function gsl_multimin_fminimizer_set

      function gsl_multimin_fminimizer_x(solver) bind(C, name='gsl_multimin_fminimizer_x') result(x)
         import :: c_ptr
         type(c_ptr), value :: solver
         type(c_ptr) :: x
      end function gsl_multimin_fminimizer_x

      function gsl_vector_get(vector, i) bind(C, name='gsl_vector_get') result(value)
         import :: c_double, c_ptr, c_size_t
         type(c_ptr), value :: vector
         integer(c_size_t), value :: i
         real(c_double) :: value
      end function gsl_vector_get

      subroutine gsl_vector_set(vector, i, value) bind(C, name='gsl_vector_set')
         import :: c_double, c_ptr, c_size_t
         type(c_ptr), value :: vector
         integer(c_size_t), value :: i
         real(c_double), value :: value
      end subroutine gsl_vector_set
   end interface

end module mfv_gsl
