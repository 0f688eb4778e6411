!> Status codes of runs and calls. Constants and texts come from include/mfv_status.def, the common list of Fortran, C and
!> Python.
module mfv_status
   implicit none
   private
   public :: status_outcome, status_explanation, status_exit_code

#define MFV_STATUS(name, code, exit_code, outcome, explanation) integer, parameter, public :: name = code
#include "mfv_status.def"
#undef MFV_STATUS

   !> Upper limit of the length of the texts: the compiler warns if one does not fit.
   integer, parameter :: longest = 80

contains

   !> Outcome of a status in words, as in the result file; "unknown status" for an unknown code.
   pure function status_outcome(status) result(words)
      integer, intent(in) :: status
      character(len=len_trim(padded_outcome(status))) :: words

      words = padded_outcome(status)
   end function status_outcome

   !> The same, padded with blanks.
   pure function padded_outcome(status) result(words)
      integer, intent(in) :: status
      character(len=longest) :: words

      words = 'unknown status'
      select case (status)
#define MFV_STATUS(name, code, exit_code, outcome, explanation) case (code); words = outcome
#include "mfv_status.def"
#undef MFV_STATUS
      end select
   end function padded_outcome

   !> Explanation of a status for users, one clause; "not in the list of statuses" for an unknown code.
   pure function status_explanation(status) result(words)
      integer, intent(in) :: status
      character(len=len_trim(padded_explanation(status))) :: words

      words = padded_explanation(status)
   end function status_explanation

   !> The same, padded with blanks.
   pure function padded_explanation(status) result(words)
      integer, intent(in) :: status
      character(len=longest) :: words

      words = 'not in the list of statuses'
      select case (status)
#define MFV_STATUS(name, code, exit_code, outcome, explanation) case (code); words = explanation
#include "mfv_status.def"
#undef MFV_STATUS
      end select
   end function padded_explanation

   !> Exit code of the programs for a status; -1 for an unknown code.
   pure integer function status_exit_code(status) result(exit_value)
      integer, intent(in) :: status

      exit_value = -1
      select case (status)
#define MFV_STATUS(name, code, exit_code, outcome, explanation) case (code); exit_value = exit_code
#include "mfv_status.def"
#undef MFV_STATUS
      end select
   end function status_exit_code

end module mfv_status
