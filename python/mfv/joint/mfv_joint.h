/* Joint element: springs with sliders (Jenkins elements) in parallel, after Iwan (1966). C99, no allocation, no global state.
 *
 * The caller owns the state: count slider positions, zero at first. An update goes from the state at the beginning of a time step to
 * any displacement and writes the state there, so that a rejected iterate is undone by not using what it wrote:
 *
 *     double sliders[8] = {0}, trial[8], force, stiffness;            (count <= 8)
 *     mfv_joint_update(&joint, sliders, displacement, trial, &force, &stiffness);
 *     memcpy(sliders, trial, joint.count * sizeof *sliders);          (once the time step is accepted)
 *
 * Displacements and forces are in the units of the arrays; forces are per unit thickness of the joint if these are.
 */
#ifndef MFV_JOINT_H
#define MFV_JOINT_H

#include <math.h>
#include <stddef.h>

typedef struct mfv_joint {
  size_t count;            /* sliders */
  const double *stiffness; /* of the spring of each */
  const double *slip;      /* displacement at which each begins to slide */
  double elastic;          /* stiffness of a spring without a slider */
} mfv_joint;

/* Go from the state `before` straight to a displacement (in total, not an increment). Writes the state there to `after`, which may be
 * `before`; the force; and the consistent tangent, the derivative of the force on in the same direction. A slider that has reached its
 * slip to round-off counts as sliding in the tangent, so that a zero increment does not change it. */
static inline void mfv_joint_update(const mfv_joint *joint, const double *before, double displacement, double *after,
                                    double *force, double *stiffness) {
  *force = joint->elastic * displacement;
  *stiffness = joint->elastic;
  for (size_t i = 0; i < joint->count; i++) {
    const double stretch = displacement - before[i], slip = joint->slip[i];
    const int stuck = fabs(stretch) < slip;
    *force += joint->stiffness[i] * (stuck ? stretch : copysign(slip, stretch));
    *stiffness += fabs(stretch) < slip - 1.0e-15 * (fabs(displacement) + slip) ? joint->stiffness[i] : 0.0;
    after[i] = stuck ? before[i] : displacement - copysign(slip, stretch);
  }
}

#endif
