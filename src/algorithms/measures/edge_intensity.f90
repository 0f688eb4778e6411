!> Intensities of the tractions at the edges of contact patches (asymptotes of fretting contacts).
!>
!> At the distance s inside an edge where the pressure vanishes it is K_N sqrt(s); a change of the shear traction without slip is
!> K_T/sqrt(s), and a sharp corner has the pressure K_C/sqrt(s) (Hills, Andresen, Moore and Barber; derivation and tests:
!> docs/theory.md, intensities at edges). With full coupling and slip the exponents differ from 1/2 by l, tan(pi l) = beta tau/p
!> (mfv_zone_edges): the factors are then those of sqrt(s) (s/c)^l and (s/c)^l/sqrt(s), c half the length of the patch. They follow
!> from the outermost three nodes by the discrete solutions of mfv_edge_solutions, without the discretisation error there.
module mfv_edge_intensity
   use, intrinsic :: ieee_arithmetic, only: ieee_quiet_nan, ieee_value
   use mfv_contact_model, only: contact_model_type
   use mfv_contact_state, only: contact_state_type
   use mfv_edge_solutions, only: find_singular_factor, graded_solution_type, least_power, most_power, new_graded_solution, &
                                 root_factor
   use mfv_kinds, only: wp
   use mfv_zone_edges, only: has_known_error, patch_type
   implicit none
   private
   public :: find_root_intensity, samples, singular_intensities

   !> Nodes that an asymptote is found from; the next one must agree.
   integer, parameter :: samples = 3

contains

   !> The pressure at the left (`side` -1) or right (1) edge of a patch where it vanishes: `intensity` K_N, force/length^(5/2), and
   !> `reach`, length, the distance at which the pressure differs from that by a tenth. NaN at sharp corners, with fewer
   !> than three nodes, where the profile is not smooth there, and where the equations are not those of mfv_edge_solutions.
   subroutine find_root_intensity(model, state, patch, side, intensity, reach)
      type(contact_model_type), intent(in) :: model
      type(contact_state_type), intent(in) :: state
      type(patch_type), intent(in) :: patch
      integer, intent(in) :: side
      real(wp), intent(out) :: intensity, reach
      !> Part by which the next three nodes may give another intensity: kinks of profiles change it from node to node.
      real(wp), parameter :: smooth = 0.05_wp
      real(wp) :: factor, farther, unit, power

      intensity = ieee_value(1.0_wp, ieee_quiet_nan)
      reach = intensity
      power = merge(patch%right_power, patch%left_power, side > 0)
      if (merge(patch%right_ends, patch%left_ends, side > 0) .or. .not. is_known(model, patch, side, power)) return
      associate (pressure => inwards(state%fields%pressure, patch, side))
         if (allocated(model%scene%mesh%ends)) then
            call solve_graded()
         else
            unit = model%width(outermost(patch, side))
            factor = root_factor(pressure(:samples), power, 0)
            farther = factor
            if (size(pressure) > samples) farther = root_factor(pressure(2:samples + 1), power, 1)
         end if
      end associate
      if (.not. factor > 0.0_wp .or. abs(farther - factor) > smooth*factor) return
      intensity = factor/unit**power
      reach = reach_of(model, state%fields%pressure/intensity, patch, side, power)
      intensity = intensity*half_length(patch)**(power - 0.5_wp)

   contains

      subroutine solve_graded()
         type(graded_solution_type) :: solution

         solution = graded_at(model, patch, side, power)
         unit = solution%length_unit()
         associate (pressure => inwards(state%fields%pressure, patch, side))
            factor = solution%graded_root(pressure(:samples), 0)
            farther = factor
            if (size(pressure) > samples) farther = solution%graded_root(pressure(2:samples + 1), 1)
         end associate
      end subroutine solve_graded
   end subroutine find_root_intensity

   !> Distance from an edge, length, at which the `pressure`, over its intensity, shape (nodes), differs from s^power by a tenth;
   !> NaN if it does not in the outer half of the patch. On unequal intervals pressures are means. The outermost nodes have the
   !> largest discretisation error and are omitted.
   pure real(wp) function reach_of(model, pressure, patch, side, power) result(reach)
      type(contact_model_type), intent(in) :: model
      real(wp), intent(in) :: pressure(:), power
      type(patch_type), intent(in) :: patch
      integer, intent(in) :: side
      real(wp), parameter :: small = 0.1_wp
      integer, parameter :: omitted = 2
      real(wp), allocatable :: s(:), half(:), rest(:)
      integer :: nodes, i

      reach = ieee_value(1.0_wp, ieee_quiet_nan)
      nodes = patch%last - patch%first + 1
      s = abs(inwards(model%arc, patch, side, nodes) - merge(patch%right, patch%left, side > 0))
      half = 0.5_wp*inwards(model%width, patch, side, nodes)
      if (.not. allocated(model%scene%mesh%ends)) half = 0.0_wp
      rest = abs(inwards(pressure, patch, side, nodes)/max(mean_power(s, half, power), tiny(1.0_wp)) - 1.0_wp)
      i = omitted + findloc(rest(omitted + 1:) > small, .true., dim=1)
      if (i < omitted + 2) return
      if (s(i) > half_length(patch)) return
      reach = s(i - 1) + (s(i) - s(i - 1))*(small - rest(i - 1))/(rest(i) - rest(i - 1))
   end function reach_of

   !> Mean of s**power from s - half to s + half.
   elemental real(wp) function mean_power(s, half, power)
      real(wp), intent(in) :: s, half, power

      mean_power = s**power
      if (half > 0.0_wp) mean_power = ((s + half)**(power + 1.0_wp) - max(s - half, 0.0_wp)**(power + 1.0_wp))/ &
                                      (2.0_wp*half*(power + 1.0_wp))
   end function mean_power

   !> Intensities at the left and right edge of a patch, force/length^(3/2), of a `traction`, force/length^2, shape (nodes), that
   !> grows as the distance to the `powers` less one (a half, but for slip with full coupling): the pressure at corners, and
   !> tractions of stuck nodes. NaN as above; at an edge that is not `singular` 0, for that of the other one. `turns`: see
   !> move_edges.
   function singular_intensities(model, traction, patch, powers, singular, turns) result(intensities)
      type(contact_model_type), intent(in) :: model
      real(wp), intent(in) :: traction(:), powers(2)
      type(patch_type), intent(in) :: patch
      logical, intent(in) :: singular(2), turns
      real(wp) :: intensities(2)
      integer, parameter :: sides(2) = [-1, 1]
      real(wp) :: outwards(2), factor, offset, unit
      integer :: i

      intensities = 0.0_wp
      outwards = 0.0_wp
      do i = 1, size(sides)
         if (.not. singular(i)) cycle
         if (.not. is_known(model, patch, sides(i), powers(i))) then
            intensities(i) = ieee_value(1.0_wp, ieee_quiet_nan)
            cycle
         end if
         associate (values => inwards(traction, patch, sides(i)), node => outermost(patch, sides(i)))
            if (allocated(model%scene%mesh%ends)) then
               call solve_graded(values)
               outwards(i) = 0.5_wp*model%width(node)
            else
               unit = model%width(node)
               call find_singular_factor(values(:samples), powers(i), factor, offset)
               outwards(i) = offset*unit
            end if
         end associate
         intensities(i) = factor*unit**(1.0_wp - powers(i))*half_length(patch)**(powers(i) - 0.5_wp)
      end do
      if (all(singular)) call move_edges(model, patch, outwards, turns, intensities)

   contains

      subroutine solve_graded(values)
         real(wp), intent(in) :: values(:)
         type(graded_solution_type) :: solution

         solution = graded_at(model, patch, sides(i), powers(i))
         unit = solution%length_unit()
         factor = solution%graded_singular(values)
      end subroutine solve_graded
   end function singular_intensities

   !> Intensities at the edges of a patch from those of the discrete solution, whose edges lie `outwards` of the outermost nodes,
   !> lengths. Tractions (m + d (x - x0))/sqrt((x - l)(r - x)), x0 the middle, have the resultant pi m and the displacement A d x:
   !> m is that of the force; d that of the strain, or of the rotation, wherever the edges are, or of a prescribed moment (`turns`):
   !> pi d/8 times the square of the length.
   pure subroutine move_edges(model, patch, outwards, turns, intensities)
      type(contact_model_type), intent(in) :: model
      type(patch_type), intent(in) :: patch
      real(wp), intent(in) :: outwards(2)
      logical, intent(in) :: turns
      real(wp), intent(inout) :: intensities(2)
      real(wp) :: length, mean, slope

      length = model%arc(patch%last) - model%arc(patch%first) + sum(outwards)
      mean = 0.5_wp*sum(intensities)*sqrt(length)
      slope = (intensities(2) - intensities(1))/sqrt(length)
      if (turns) slope = slope*(length/patch%length())**2
      length = patch%length()
      intensities = (mean + [-0.5_wp, 0.5_wp]*slope*length)/sqrt(length)
   end subroutine move_edges

   !> Whether a discrete solution with this exponent holds at an edge of a patch.
   logical function is_known(model, patch, side, power)
      type(contact_model_type), intent(in) :: model
      type(patch_type), intent(in) :: patch
      integer, intent(in) :: side
      real(wp), intent(in) :: power

      is_known = patch%last - patch%first + 1 >= samples .and. power > least_power .and. power < most_power
      if (is_known) is_known = has_known_error(model, outermost(patch, side), samples)
   end function is_known

   !> The discrete solution of the unequal intervals at an edge of a patch.
   type(graded_solution_type) function graded_at(model, patch, side, power) result(solution)
      type(contact_model_type), intent(in) :: model
      type(patch_type), intent(in) :: patch
      integer, intent(in) :: side
      real(wp), intent(in) :: power

      solution = new_graded_solution(inwards(model%width, patch, side), power)
   end function graded_at

   !> Values of the outermost nodes of a patch from its left (`side` -1) or right (1) edge inwards, `most` at most.
   pure function inwards(values, patch, side, most)
      real(wp), intent(in) :: values(:)
      type(patch_type), intent(in) :: patch
      integer, intent(in) :: side
      integer, intent(in), optional :: most
      real(wp), allocatable :: inwards(:)
      integer :: number

      number = patch%last - patch%first + 1
      if (present(most)) number = min(number, most)
      associate (edge => outermost(patch, side))
         inwards = values(edge:edge - side*(number - 1):-side)
      end associate
   end function inwards

   pure integer function outermost(patch, side)
      type(patch_type), intent(in) :: patch
      integer, intent(in) :: side

      outermost = merge(patch%last, patch%first, side > 0)
   end function outermost

   pure real(wp) function half_length(patch)
      type(patch_type), intent(in) :: patch

      half_length = 0.5_wp*patch%length()
   end function half_length

end module mfv_edge_intensity
