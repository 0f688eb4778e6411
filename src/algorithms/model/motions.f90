!> The motions of the upper body relative to the lower one, and their forces: a table with a row for each. Arrays with a value for
!> every motion (loads, controls, arms, records, tangents, keys, fields) have the order of the rows. A new motion requires a row
!> here, its arms (place_arms of mfv_contact_model), and its names for users: in mfv, step_to of mfv_contact, include/mfv.h,
!> python/mfv/loads.py and Step of python/mfv/scene.py.
module mfv_motions
   use mfv_kinds, only: wp
   implicit none
   private
   public :: motion_type, motions, motion_count, motion_approach, motion_shift, motion_rotation, control_keep, control_force, &
             control_displacement, controlled_key, arm_unit

   !> Approach (down), shift (to the right) and rotation (counterclockwise) of the upper body, and the number of motions.
   integer, parameter :: motion_approach = 1, motion_shift = 2, motion_rotation = 3, motion_count = 3

   !> Control of a motion by a step: unchanged load, prescribed force (moment), prescribed displacement (rotation).
   integer, parameter :: control_keep = 0, control_force = 1, control_displacement = 2

   type :: motion_type
      !> Keys and field names of the displacement and its force.
      character(len=8) :: key
      character(len=16) :: force_key
      !> Name of the force in messages.
      character(len=16) :: force_name
      !> Units in terms of length and force (forces are per unit thickness).
      character(len=7) :: unit
      character(len=12) :: force_unit
      !> Meaning of the fields of a result.
      character(len=64) :: meaning
      character(len=96) :: force_meaning
      !> Meaning of the keys of a &step.
      character(len=96) :: target
      character(len=144) :: force_target
      !> The residual of its balance with the tractions, and its meaning.
      character(len=24) :: balance
      character(len=32) :: balance_meaning
      !> Whether the force cannot be negative.
      logical :: pushes = .false.
      !> Whether its arms are lengths, so that its force is a moment.
      logical :: turns = .false.
      !> Whether it is fixed and not modelled until a step controls it; approach and shift are always modelled.
      logical :: optional = .false.
   end type motion_type

   type(motion_type), parameter :: motions(motion_count) = [ &
                                   motion_type( &
                    key='approach', force_key='normal_force', force_name='normal force', unit='length', force_unit='force/length', &
                                   meaning='approach of the upper body', force_meaning='normal force P per unit thickness', &
                                   target='target of the approach of the upper body, in place of normal_force', &
                     force_target='target of the normal force P', balance='normal_force_balance', balance_meaning='P - sum(p) dx', &
                                   pushes=.true.), &
                                   motion_type( &
               key='shift', force_key='tangential_force', force_name='tangential force', unit='length', force_unit='force/length', &
                            meaning='shift of the upper body to the right', force_meaning='tangential force Q per unit thickness', &
                                   target='target of the shift of the upper body to the right, in place of tangential_force', &
                                   force_target='target of the tangential force Q, positive to the right', &
                                   balance='tangential_force_balance', balance_meaning='Q - sum(tau) dx'), &
                                   motion_type( &
                                   key='rotation', force_key='moment', force_name='moment', unit='radians', force_unit='force', &
                                   meaning='rotation of the upper body, counterclockwise, in radians', &
                                   force_meaning='moment M of the upper on the lower body per unit thickness, counterclockwise', &
                                   target='target of the rotation of the upper body about the same point, in place of moment', &
            force_target='target of the moment M about the centre of the upper disk or hole, else of the lower one, else about '// &
                                   'the origin of x; counterclockwise', &
                            balance='moment_balance', balance_meaning='M - moment of the tractions', turns=.true., optional=.true.)]

contains

   !> The key for the force or the displacement of a motion; padded with blanks.
   pure character(len=16) function controlled_key(motion, control)
      integer, intent(in) :: motion, control

      controlled_key = motions(motion)%key
      if (control == control_force) controlled_key = motions(motion)%force_key
   end function controlled_key

   !> Unit of the arms of a motion: `length`, or 1 if they are dimensionless.
   elemental real(wp) function arm_unit(motion, length)
      integer, intent(in) :: motion
      real(wp), intent(in) :: length

      arm_unit = 1.0_wp
      if (motions(motion)%turns) arm_unit = length
   end function arm_unit

end module mfv_motions
