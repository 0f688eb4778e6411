!> A rigid cylinder is pressed on an elastic half-plane without friction and then sheared.
program cylinder
   use mfv
   implicit none
   type(draft_type) :: scene
   type(contact_type) :: contact
   type(loads_type) :: loads
   type(error_type), allocatable :: error
   character(:), allocatable :: message
   real(wp), allocatable :: shear(:)

   call scene%set('body(1)%shape', 'half_plane')
   call scene%set('body(1)%shear_modulus', 1.0_wp)
   call scene%set('body(1)%poisson_ratio', 0.3_wp)
   call scene%set('body(2)%shape', 'disk')
   call scene%set('body(2)%radius', 0.25_wp)
   call scene%set('body(2)%rigid', .true.)
   call scene%set('mesh%nodes', 101)
   call scene%set('mesh%half_width', 0.0125_wp)
   call scene%set('friction%law', 'coulomb')
   call scene%set('friction%mu', 0.7_wp)
   call new_contact(scene, contact, error)                    ! errors of the scene are reported here
   if (.not. allocated(error)) call contact%advance(step_to(normal_force=1.0e-3_wp, friction=.false.), error)
   if (.not. allocated(error)) call contact%advance(step_to(tangential_force=2.8e-4_wp), error)
   if (.not. allocated(error)) call contact%get('state/shear', shear, error)
   if (allocated(error)) error stop error%message
   call contact%get_message(message)                          ! what was reached, or why the run ended early
   if (contact%status() /= MFV_COMPLETE) error stop message

   loads = contact%loads()
   print '(a, i0, a, i0)', 'nodes in contact ', loads%contact_nodes, ', stuck ', loads%stick_nodes
   print '(a, es12.6)', 'shift ', loads%motion(motion_shift), 'dissipation ', loads%dissipation, 'peak shear ', maxval(shear)
end program cylinder
