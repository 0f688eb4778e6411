!> What a run or a call can end with. Constants and texts come from include/mfv_status.def,
!> the one list that the C header and the Python package use too.
module mfv_status
   implicit none
   private
   public :: status_outcome, status_explanation, status_exit_code

#define MFV_STATUS(name, code, exit_code, outcome, explanation) integer, parameter, public :: name = code
#include "mfv_status.def"
#undef MFV_STATUS

   !> No text in the list is longer: the compiler warns of one that does not fit.
   integer, parameter :: longest = 80

contains

   !> Outcome of a status in words, as the result file has it; "unknown status" for a code not in the list.
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

   !> One clause that explains a status to a user; "not in the list of statuses" for an unknown code.
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

   !> Exit code with which the programs end for a status; -1 for an unknown code.
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
