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
   !> Rows of the list, whose codes are 0, 1, 2, ...; the last row is that of unknown codes.
   character(*), parameter :: outcomes(0:*) = [character(len=longest) :: &
#define MFV_STATUS(name, code, exit_code, outcome, explanation) outcome, &
#include "mfv_status.def"
#undef MFV_STATUS
                                               'unknown status']
   character(*), parameter :: explanations(0:*) = [character(len=longest) :: &
#define MFV_STATUS(name, code, exit_code, outcome, explanation) explanation, &
#include "mfv_status.def"
#undef MFV_STATUS
                                                   'not in the list of statuses']
   integer, parameter :: exit_codes(0:*) = [ &
#define MFV_STATUS(name, code, exit_code, outcome, explanation) exit_code, &
#include "mfv_status.def"
#undef MFV_STATUS
                         -1]

contains

   !> Outcome of a status in words, as in the result file; "unknown status" for an unknown code.
   pure function status_outcome(status) result(words)
      integer, intent(in) :: status
      character(len=len_trim(outcomes(row_of(status)))) :: words

      words = outcomes(row_of(status))
   end function status_outcome

   !> Explanation of a status for users, one clause; "not in the list of statuses" for an unknown code.
   pure function status_explanation(status) result(words)
      integer, intent(in) :: status
      character(len=len_trim(explanations(row_of(status)))) :: words

      words = explanations(row_of(status))
   end function status_explanation

   !> Exit code of the programs for a status; -1 for an unknown code.
   pure integer function status_exit_code(status) result(exit_value)
      integer, intent(in) :: status

      exit_value = exit_codes(row_of(status))
   end function status_exit_code

   !> Row of a status in the arrays.
   pure integer function row_of(status)
      integer, intent(in) :: status

      row_of = status
      if (status < 0 .or. status > ubound(exit_codes, 1)) row_of = ubound(exit_codes, 1)
   end function row_of

end module mfv_status
