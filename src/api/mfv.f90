!> The Fortran interface of the library. Guide: docs/fortran-api.md; complete programs: examples/hosts/.
!>
!> - draft_type: scene builder, `call draft%set('body(2)%radius', 0.25_wp)`; read_draft: from a text
!> - contact_type: a case with its state, from new_contact (scene builder), read_contact (file) or read_contact_text
!> - contact%run, contact%advance with step_to(...); contact%loads(), contact%get('state/pressure', values, error)
!> - contact%get_tangent; contact%differentiate and contact%get_derivative
!> - contact%keep and contact%come_back with a kept_state_type
!> - contact%find_interior: interior%all_stresses, largest_von_mises, largest_tension; contact%write
!> - observer_type: extend it to follow every increment
!> - error_type: what went wrong; the MFV_... statuses with status_outcome and status_explanation
!>
!> Units: any consistent set; forces and energies per unit thickness. Objects are independent of each other: one thread an object at
!> a time.
module mfv
   use mfv_contact, only: contact_type, derivative_type, loads_type, new_contact, read_contact, read_contact_text, step_to, &
                          body_lower, body_upper
   use mfv_contact_state, only: contact_state_type
   use mfv_draft, only: draft_type, read_draft
   use mfv_error, only: error_type
   use mfv_features, only: has_hdf5
   use mfv_interior, only: interior_type, stress_count, stress_names
   use mfv_stress_search, only: largest_tension, largest_type, largest_von_mises
   use mfv_kept_state, only: kept_state_type
   use mfv_kinds, only: wp
   use mfv_motions, only: motion_count => user_motions, motion_approach, motion_shift, motion_rotation, motion_lower_bulk, &
                          motion_upper_bulk, motion_interference, control_keep, control_force, control_displacement
   use mfv_node_status, only: node_open, node_stick, node_slip_right, node_slip_left, node_frictionless, node_creep_right, &
                              node_creep_left
   use mfv_observer, only: observer_type
   use mfv_reference_flat_punch, only: flat_punch_pressure
   use mfv_reference_hertz, only: hertz_half_width, hertz_force, hertz_pressure, hertz_approach
   use mfv_reference_indenter, only: indenter_type, power_indenter, rounded_punch_indenter
   use mfv_reference_mindlin, only: mindlin_stick_ratio, mindlin_dissipation, mindlin_history_type, new_mindlin_history
   use mfv_reference_oblique, only: oblique_half_width, oblique_stick_ratio
   use mfv_reference_persson, only: persson_force
   use mfv_reference_spence, only: spence_cylinder_shear, spence_flat_punch_shear, spence_stick_ratio
   use mfv_reference_wave, only: wave_type, new_wave_contact
   use mfv_reference_yield, only: contact_arc_at_yield
   use mfv_scene, only: step_type
   use mfv_status
   use mfv_strings, only: string_type
   use mfv_version, only: library_version
   implicit none
   public
end module mfv
