!> Interfaces to BLAS and LAPACK (double precision; documented by Netlib).
module mfv_lapack
   use mfv_kinds, only: wp
   implicit none
   private
   public :: ddot, dgemm, dgemv, dger, dgesv, dgetrf, dgetri, dgetrs, dpotrf, dpotri, dtrsv

   interface
      pure function ddot(n, x, incx, y, incy) result(product)
         import :: wp
         integer, intent(in) :: n, incx, incy
         real(wp), intent(in) :: x(*), y(*)
         real(wp) :: product
      end function ddot

      subroutine dgemm(transa, transb, m, n, k, alpha, a, lda, b, ldb, beta, c, ldc)
         import :: wp
         character, intent(in) :: transa, transb
         integer, intent(in) :: m, n, k, lda, ldb, ldc
         real(wp), intent(in) :: alpha, beta, a(lda, *), b(ldb, *)
         real(wp), intent(inout) :: c(ldc, *)
      end subroutine dgemm

      subroutine dgemv(trans, m, n, alpha, a, lda, x, incx, beta, y, incy)
         import :: wp
         character, intent(in) :: trans
         integer, intent(in) :: m, n, lda, incx, incy
         real(wp), intent(in) :: alpha, beta, a(lda, *), x(*)
         real(wp), intent(inout) :: y(*)
      end subroutine dgemv

      subroutine dger(m, n, alpha, x, incx, y, incy, a, lda)
         import :: wp
         integer, intent(in) :: m, n, incx, incy, lda
         real(wp), intent(in) :: alpha, x(*), y(*)
         real(wp), intent(inout) :: a(lda, *)
      end subroutine dger

      subroutine dgesv(n, nrhs, a, lda, ipiv, b, ldb, info)
         import :: wp
         integer, intent(in) :: n, nrhs, lda, ldb
         real(wp), intent(inout) :: a(lda, *), b(ldb, *)
         integer, intent(out) :: ipiv(*), info
      end subroutine dgesv

      subroutine dgetrf(m, n, a, lda, ipiv, info)
         import :: wp
         integer, intent(in) :: m, n, lda
         real(wp), intent(inout) :: a(lda, *)
         integer, intent(out) :: ipiv(*), info
      end subroutine dgetrf

      subroutine dgetri(n, a, lda, ipiv, work, lwork, info)
         import :: wp
         integer, intent(in) :: n, lda, lwork, ipiv(*)
         real(wp), intent(inout) :: a(lda, *), work(*)
         integer, intent(out) :: info
      end subroutine dgetri

      subroutine dgetrs(trans, n, nrhs, a, lda, ipiv, b, ldb, info)
         import :: wp
         character, intent(in) :: trans
         integer, intent(in) :: n, nrhs, lda, ldb, ipiv(*)
         real(wp), intent(in) :: a(lda, *)
         real(wp), intent(inout) :: b(ldb, *)
         integer, intent(out) :: info
      end subroutine dgetrs

      subroutine dpotrf(uplo, n, a, lda, info)
         import :: wp
         character, intent(in) :: uplo
         integer, intent(in) :: n, lda
         real(wp), intent(inout) :: a(lda, *)
         integer, intent(out) :: info
      end subroutine dpotrf

      subroutine dpotri(uplo, n, a, lda, info)
         import :: wp
         character, intent(in) :: uplo
         integer, intent(in) :: n, lda
         real(wp), intent(inout) :: a(lda, *)
         integer, intent(out) :: info
      end subroutine dpotri

      subroutine dtrsv(uplo, trans, diag, n, a, lda, x, incx)
         import :: wp
         character, intent(in) :: uplo, trans, diag
         integer, intent(in) :: n, lda, incx
         real(wp), intent(in) :: a(lda, *)
         real(wp), intent(inout) :: x(*)
      end subroutine dtrsv
   end interface

end module mfv_lapack
