!> The motions of the upper body relative to the lower one, and their forces: a table with a row for each. Bulk stresses are motions
!> too: a uniform stress sigma_xx displaces the surface of its body in proportion to the position. Arrays with a value for
!> every motion (loads, controls, arms, records, tangents, keys, fields) have the order of the rows. A new motion requires a row
!> here, its arms (place_arms of mfv_contact_model), and its names for users: in mfv, step_to of mfv_contact, include/mfv.h,
!> python/mfv/loads.py and Step of python/mfv/scene.py.
module mfv_motions
   use mfv_kinds, only: wp
   implicit none
   private
   public :: motions, motion_count, motion_approach, motion_shift, motion_rotation, motion_lower_bulk, &
             motion_upper_bulk, motion_interference, motion_wear, user_motions, bulk_motions, control_keep, control_force, &
             control_displacement, controlled_key, first_control, arm_unit

   !> Approach (down), shift (to the right) and rotation (counterclockwise) of the upper body; the bulk stress of either body; the
   !> interference, by which one body is larger; the growth of the gap by wear in a block of cycles, from 0 to 1; and the number of
   !> motions.
   integer, parameter :: motion_approach = 1, motion_shift = 2, motion_rotation = 3, motion_lower_bulk = 4, motion_upper_bulk = 5, &
                         motion_interference = 6, motion_wear = 7, motion_count = 7
   !> The first motions are those of the user, in steps, results and interfaces.
   integer, parameter :: user_motions = 6

   !> The bulk stress of the lower and the upper body.
   integer, parameter :: bulk_motions(2) = [motion_lower_bulk, motion_upper_bulk]

   !> Control of a motion by a step: unchanged load, prescribed force (moment), prescribed displacement (rotation).
   integer, parameter :: control_keep = 0, control_force = 1, control_displacement = 2

   type :: motion_type
      !> Keys and field names of the displacement and its force.
      character(len=17) :: key
      character(len=17) :: force_key
      !> Name of the force in messages.
      character(len=17) :: force_name
      !> Units in terms of length and force (forces are per unit thickness).
      character(len=14) :: unit
      character(len=12) :: force_unit
      !> Meaning of the fields of a result.
      character(len=80) :: meaning
      character(len=112) :: force_meaning
      !> Meaning of the keys of a &step.
      character(len=144) :: target
      character(len=144) :: force_target
      !> The residual of its balance with the tractions, and its meaning.
      character(len=26) :: balance
      character(len=40) :: balance_meaning
      !> Whether what a step prescribes of it first (first_control) cannot be negative; a force can in a neat fit.
      logical :: pushes = .false.
      !> Whether its arms are lengths, so that its force is a moment (wear: an energy).
      logical :: turns = .false.
      !> Whether it is fixed and not modelled until a step controls it; approach and shift are always modelled.
      logical :: optional = .false.
      !> Whether it is a bulk stress.
      logical :: is_stress = .false.
      !> Whether it is always prescribed, by its value, and changes gaps only or slips only: a bulk stress, an interference,
      !> wear.
      logical :: is_known = .false.
   end type motion_type

   type(motion_type), parameter :: motions(motion_count) = [ &
                                   motion_type( &
                    key='approach', force_key='normal_force', force_name='normal force', unit='length', force_unit='force/length', &
                                   meaning='approach of the upper body', force_meaning='normal force P per unit thickness', &
                                   target='target of the approach of the upper body, in place of normal_force', &
                                   force_target='target of the normal force P, down; at least 0 except in a neat fit', &
                                   balance='normal_force_balance', balance_meaning='P - sum(p) dx', &
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
                                   force_meaning='moment M of the upper on the lower body per unit thickness about the '// &
                                   'centre of rotation, counterclockwise', &
                                   target='target of the rotation of the upper body about the same point, in place of moment', &
                   force_target='target of the moment M about the centre of the disk (the upper one of two), else of the hole, '// &
                                   'else about the origin of x; counterclockwise', &
                          balance='moment_balance', balance_meaning='M - moment of the tractions', turns=.true., optional=.true.), &
                                   motion_type( &
                    key='lower_bulk_stress', force_key='lower_contraction', force_name='lower contraction', unit='force/length^2', &
                                   force_unit='length^2', &
                                   meaning='bulk stress sigma_xx of the lower body, positive in tension', &
                           force_meaning='area by which the shear tractions shorten the lower body, conjugate to its bulk stress', &
                             target='target of the bulk stress of the lower body: a uniform stress sigma_xx, positive in tension', &
                                   force_target='', balance='lower_contraction_balance', &
                       balance_meaning='contraction - that by the tractions', optional=.true., is_stress=.true., is_known=.true.), &
                                   motion_type( &
                    key='upper_bulk_stress', force_key='upper_contraction', force_name='upper contraction', unit='force/length^2', &
                                   force_unit='length^2', &
                                   meaning='bulk stress sigma_xx of the upper body, positive in tension', &
                           force_meaning='area by which the shear tractions shorten the upper body, conjugate to its bulk stress', &
                                   target='target of the bulk stress of the upper body, likewise', &
                                   force_target='', balance='upper_contraction_balance', &
                       balance_meaning='contraction - that by the tractions', optional=.true., is_stress=.true., is_known=.true.), &
                                   motion_type( &
                                   key='interference', force_key='closing_force', force_name='closing force', unit='length', &
                                   force_unit='force/length', meaning='interference: distance by which it closes all gaps', &
                                   force_meaning='sum of the pressure along the surface, conjugate to the interference', &
                                   target='target of the interference: by how much the radius of a pin exceeds that of its '// &
                                   'bore, or a pad is higher than its place; closes all gaps', &
                                   force_target='', balance='closing_force_balance', &
                                   balance_meaning='closing force - sum of the pressure', pushes=.true., optional=.true., &
                                   is_known=.true.), &
                                   motion_type( &
                                   key='wear', force_key='wear_energy', force_name='energy of wear', unit='1', &
                                   force_unit='force', meaning='part of the wear of a block of cycles', &
                                   force_meaning='elastic energy that all wear of the block releases, with its sign reversed', &
                                   target='', force_target='', balance='wear_balance', &
                                   balance_meaning='energy of wear - that of the pressure', turns=.true., optional=.true., &
                                   is_known=.true.)]

contains

   !> The key for the force or the displacement of a motion; padded with blanks.
   pure character(len=17) function controlled_key(motion, control)
      integer, intent(in) :: motion, control

      controlled_key = motions(motion)%key
      if (control == control_force) controlled_key = motions(motion)%force_key
   end function controlled_key

   !> The first control by which a step can prescribe a motion: its force, or its value if that is always prescribed.
   elemental integer function first_control(motion)
      integer, intent(in) :: motion

      first_control = merge(control_displacement, control_force, motions(motion)%is_known)
   end function first_control

   !> Unit of the arms of a motion: 1; `length` for a moment; `length` over `modulus`, force/length^2, for a bulk stress.
   elemental real(wp) function arm_unit(motion, length, modulus)
      integer, intent(in) :: motion
      real(wp), intent(in) :: length, modulus

      arm_unit = 1.0_wp
      if (motions(motion)%turns) arm_unit = length
      if (motions(motion)%is_stress) arm_unit = length/modulus
   end function arm_unit

end module mfv_motions
