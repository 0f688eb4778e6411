!> Bindings to the GNU Scientific Library.
!>
!> GSL's default error handler aborts the process, and replacing it would change the state of the host program: callers must
!> stay inside the domain in which these functions cannot fail.
module mfv_gsl
   use, intrinsic :: iso_c_binding, only: c_double, c_int, c_ptr, c_funptr, c_size_t
   implicit none
   private :: c_double, c_int, c_ptr, c_funptr, c_size_t

   !> Precision mode of the elliptic integrals: full double precision.
   integer(c_int), parameter :: GSL_PREC_DOUBLE = 0

   !> A function of one variable and its parameters, for GSL's solvers.
   type, bind(C) :: gsl_function
      type(c_funptr) :: function
      type(c_ptr) :: params
   end type gsl_function

   !> A function of several variables and its parameters.
   type, bind(C) :: gsl_multimin_function
      type(c_funptr) :: f
      integer(c_size_t) :: n
      type(c_ptr) :: params
   end type gsl_multimin_function

   !> Constants of GSL: Brent's root solver, linear and Steffen's monotone cubic interpolation, Nelder and Mead's simplex
   !> search. Public, or the linker would treat them as variables of this library.
   type(c_ptr), protected, bind(C, name='gsl_root_fsolver_brent') :: gsl_root_fsolver_brent
   type(c_ptr), protected, bind(C, name='gsl_interp_linear') :: gsl_interp_linear
   type(c_ptr), protected, bind(C, name='gsl_interp_steffen') :: gsl_interp_steffen
   type(c_ptr), protected, bind(C, name='gsl_multimin_fminimizer_nmsimplex2') :: gsl_multimin_fminimizer_nmsimplex2

   interface
      !> Carlson's symmetric elliptic integral of the first kind.
      pure function gsl_sf_ellint_RF(x, y, z, mode) bind(C, name='gsl_sf_ellint_RF')
         import :: c_double, c_int
         real(c_double), value :: x, y, z
         integer(c_int), value :: mode
         real(c_double) :: gsl_sf_ellint_RF
      end function gsl_sf_ellint_RF

      function gsl_root_fsolver_alloc(kind) bind(C, name='gsl_root_fsolver_alloc')
         import :: c_ptr
         type(c_ptr), value :: kind
         type(c_ptr) :: gsl_root_fsolver_alloc
      end function gsl_root_fsolver_alloc

      subroutine gsl_root_fsolver_free(solver) bind(C, name='gsl_root_fsolver_free')
         import :: c_ptr
         type(c_ptr), value :: solver
      end subroutine gsl_root_fsolver_free

      function gsl_root_fsolver_set(solver, f, lower, upper) bind(C, name='gsl_root_fsolver_set')
         import :: c_double, c_int, c_ptr, gsl_function
         type(c_ptr), value :: solver
         type(gsl_function), intent(in) :: f
         real(c_double), value :: lower, upper
         integer(c_int) :: gsl_root_fsolver_set
      end function gsl_root_fsolver_set

      function gsl_root_fsolver_iterate(solver) bind(C, name='gsl_root_fsolver_iterate')
         import :: c_int, c_ptr
         type(c_ptr), value :: solver
         integer(c_int) :: gsl_root_fsolver_iterate
      end function gsl_root_fsolver_iterate

      function gsl_root_fsolver_root(solver) bind(C, name='gsl_root_fsolver_root')
         import :: c_double, c_ptr
         type(c_ptr), value :: solver
         real(c_double) :: gsl_root_fsolver_root
      end function gsl_root_fsolver_root

      function gsl_interp_alloc(kind, n) bind(C, name='gsl_interp_alloc')
         import :: c_ptr, c_size_t
         type(c_ptr), value :: kind
         integer(c_size_t), value :: n
         type(c_ptr) :: gsl_interp_alloc
      end function gsl_interp_alloc

      subroutine gsl_interp_free(interpolation) bind(C, name='gsl_interp_free')
         import :: c_ptr
         type(c_ptr), value :: interpolation
      end subroutine gsl_interp_free

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

      function gsl_multimin_fminimizer_alloc(kind, n) bind(C, name='gsl_multimin_fminimizer_alloc') result(solver)
         import :: c_ptr, c_size_t
         type(c_ptr), value :: kind
         integer(c_size_t), value :: n
         type(c_ptr) :: solver
      end function gsl_multimin_fminimizer_alloc

      function gsl_multimin_fminimizer_set(solver, f, x, step) bind(C, name='gsl_multimin_fminimizer_set') result(code)
         import :: c_int, c_ptr, gsl_multimin_function
         type(c_ptr), value :: solver, x, step
         type(gsl_multimin_function), intent(in) :: f
         integer(c_int) :: code
      end function gsl_multimin_fminimizer_set

      function gsl_multimin_fminimizer_iterate(solver) bind(C, name='gsl_multimin_fminimizer_iterate') result(code)
         import :: c_int, c_ptr
         type(c_ptr), value :: solver
         integer(c_int) :: code
      end function gsl_multimin_fminimizer_iterate

      function gsl_multimin_fminimizer_x(solver) bind(C, name='gsl_multimin_fminimizer_x') result(x)
         import :: c_ptr
         type(c_ptr), value :: solver
         type(c_ptr) :: x
      end function gsl_multimin_fminimizer_x

      function gsl_multimin_fminimizer_size(solver) bind(C, name='gsl_multimin_fminimizer_size') result(size)
         import :: c_double, c_ptr
         type(c_ptr), value :: solver
         real(c_double) :: size
      end function gsl_multimin_fminimizer_size

      subroutine gsl_multimin_fminimizer_free(solver) bind(C, name='gsl_multimin_fminimizer_free')
         import :: c_ptr
         type(c_ptr), value :: solver
      end subroutine gsl_multimin_fminimizer_free

      function gsl_vector_alloc(n) bind(C, name='gsl_vector_alloc') result(vector)
         import :: c_ptr, c_size_t
         integer(c_size_t), value :: n
         type(c_ptr) :: vector
      end function gsl_vector_alloc

      subroutine gsl_vector_free(vector) bind(C, name='gsl_vector_free')
         import :: c_ptr
         type(c_ptr), value :: vector
      end subroutine gsl_vector_free

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
