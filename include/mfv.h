/* MFV: two-dimensional frictional elastic contact by the Method of First Violation. C interface.
 *
 * A case is created from a namelist text or file (docs/namelist.md), run or advanced step by step, and asked for its
 * fields by the same paths as in the result file (docs/file-format.md), "state/pressure" for one; the scales that the
 * file repeats in every group are "mesh/x", "history/record" and "cycles/cycle" alone. Units: any consistent set; forces and energies
 * per unit thickness. Every call returns a status; mfv_message tells more. The library never prints, never stops the
 * process and has no global state: handles are independent of each other, one thread a handle at a time (mfv_write in
 * two threads at once needs an HDF5 that is thread-safe, as Debian's is). Texts go out through the caller's buffer with
 * its size, cut where they do not fit, always null-terminated.
 */
#ifndef MFV_H
#define MFV_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* What a call or a run can end with: the list is mfv_status.def. */
typedef enum mfv_status {
#define MFV_STATUS(name, code, exit_code, outcome, explanation) name = code,
#include "mfv_status.def"
#undef MFV_STATUS
  MFV_STATUS_COUNT
} mfv_status;

/* What a step does with the normal, the tangential or the rotational load. */
enum { MFV_KEEP = 0, MFV_FORCE = 1, MFV_DISPLACEMENT = 2 };

/* A case with its state. Opaque. */
typedef struct mfv_case mfv_case;

/* One step: targets are reached linearly from the loads now. Set every member; start from MFV_STEP_INIT. */
typedef struct mfv_step {
  size_t size;              /* sizeof(mfv_step) */
  double normal_target;     /* normal force P >= 0 [force/length] or approach [length] */
  double tangential_target; /* tangential force Q [force/length] or shift [length], positive to the right */
  int normal_control;       /* MFV_KEEP, MFV_FORCE or MFV_DISPLACEMENT */
  int tangential_control;   /* the same */
  int friction;             /* 0: friction off during this step */
  int cycles;               /* 0: go to the targets; n: go there and back n times */
  double rotational_target; /* moment M [force] or rotation [radians], counterclockwise */
  int rotational_control;   /* MFV_KEEP, MFV_FORCE (moment) or MFV_DISPLACEMENT (rotation) */
  int unused;               /* 0 */
  double steady_tolerance;  /* cycles end early when the state after two in a row is the same to within this part of the
                               largest traction; 0: never */
} mfv_step;
#define MFV_STEP_INIT {sizeof(mfv_step), 0.0, 0.0, MFV_KEEP, MFV_KEEP, 1, 0, 0.0, MFV_KEEP, 0, 0.0}

/* Version of the library, such as "0.1.0". Since 0.1.0. */
int mfv_version(char *buffer, size_t size);

/* Outcome of a status in words, and a clause that explains it. MFV_BAD_ARGUMENT for a code not in the list. Since 0.1.0. */
int mfv_status_text(int status, char *outcome, size_t outcome_size, char *explanation, size_t explanation_size);

/* Create a case from a namelist file, or from a text (`name`: what messages call it; files named in the text are looked
 * for beside it). It may have no &step when mfv_advance is to lead the loads. On failure *handle is NULL and `message`,
 * which may be NULL, tells why. Since 0.1.0. */
int mfv_create_from_file(const char *path, mfv_case **handle, char *message, size_t message_size);
int mfv_create_from_text(const char *text, const char *name, mfv_case **handle, char *message, size_t message_size);

/* Free a case and set *handle to NULL. Safe on NULL. Since 0.1.0. */
int mfv_free(mfv_case **handle);

/* Run the steps of the case that have not been run. The result file of its &output is not written: see mfv_write.
 * Returns the outcome: MFV_COMPLETE, or why the load history ended early, with the state up to there. Since 0.1.0. */
int mfv_run(mfv_case *handle);

/* Lead the loads through one more step, whatever the steps of the case are. Returns as mfv_run. Since 0.1.0. */
int mfv_advance(mfv_case *handle, const mfv_step *step);

/* Message of the last call on this handle that failed, or of its outcome. Since 0.1.0. */
int mfv_message(const mfv_case *handle, char *buffer, size_t size);

/* Number of fields of the case now, and the path of field `index` (from 0), such as "history/shift". Since 0.1.0. */
int mfv_field_count(const mfv_case *handle, size_t *count);
int mfv_field_path(const mfv_case *handle, size_t index, char *buffer, size_t size);

/* What the values of a field run along. */
enum { MFV_ALONG_NOTHING = 0, MFV_ALONG_NODES = 1, MFV_ALONG_RECORDS = 2 };

/* Of the field at `path`: number of values (1 for a scalar), whether they are whole numbers, what they run along, unit and
 * description; every out argument may be NULL. Since 0.1.0. */
int mfv_field_info(const mfv_case *handle, const char *path, size_t *count, int *is_integer, int *along,
                   char *unit, size_t unit_size, char *description, size_t description_size);

/* Attributes of the result, texts such as title, outcome, plane or input: name of attribute `index` (from 0;
 * MFV_BAD_ARGUMENT beyond the last), and text of a named one. `length`: its characters, without the terminating null.
 * `buffer` and `length` may be NULL. Since 0.1.0. */
int mfv_attribute_name(const mfv_case *handle, size_t index, char *buffer, size_t size);
int mfv_attribute(const mfv_case *handle, const char *name, char *buffer, size_t size, size_t *length);

/* Copy out the values of a field; `count` must be its number of values. Since 0.1.0. */
int mfv_copy_real(const mfv_case *handle, const char *path, double *values, size_t count);
int mfv_copy_integer(const mfv_case *handle, const char *path, int32_t *values, size_t count);

/* The two bodies. */
enum { MFV_LOWER = 0, MFV_UPPER = 1 };

/* Stresses at a point [force/length^2], positive in tension: what a point has in mfv_stress. sigma_zz: across the plane;
 * principal stresses in the plane; the last three in polar components about the centre of a disk or hole,
 * counterclockwise (NaN in a half-plane). */
enum {
  MFV_SIGMA_XX, MFV_SIGMA_YY, MFV_SIGMA_XY, MFV_SIGMA_ZZ, MFV_PRINCIPAL_1, MFV_PRINCIPAL_2, MFV_VON_MISES,
  MFV_SIGMA_RR, MFV_SIGMA_THETATHETA, MFV_SIGMA_RTHETA, MFV_STRESS_COUNT
};

/* Stresses inside a body (MFV_LOWER or MFV_UPPER) in the present state (step = 0) or in that of steps/000N (step = N), at
 * the points x[i], y[i] [length], y up from the contact: stresses[i*MFV_STRESS_COUNT + MFV_SIGMA_XX] and so on. NaN
 * outside the body. MFV_BAD_ARGUMENT for a rigid body or one given by a matrix. Since 0.1.0. */
int mfv_stress(mfv_case *handle, int body, int step, size_t count, const double *x, const double *y, double *stresses);

/* The largest von Mises stress of the body, found by refinement: place = {stress, x, y}. Since 0.1.0. */
int mfv_largest_von_mises(mfv_case *handle, int body, int step, double *place);

/* Both for tractions of the caller's, such as those of a result file: pressure and shear (on the lower body, to the right)
 * on `nodes` intervals of the lengths width[] around the positions arc[] along the surface. stresses or place may be
 * NULL. Since 0.1.0. */
int mfv_stress_under(mfv_case *handle, int body, size_t nodes, const double *arc, const double *width,
                     const double *pressure, const double *shear, size_t count, const double *x, const double *y,
                     double *stresses, double *place);

/* Write the result file (HDF5) to `path`, or where the case's &output says when `path` is NULL. An existing file is
 * replaced only by a complete one. Since 0.1.0. */
int mfv_write(mfv_case *handle, const char *path);

/* Closed forms, for tests and pictures; NaN outside their domain. P, Q: forces per unit thickness; a: contact half-width;
 * mu: coefficient of friction; beta: Dundurs' parameter (kappa-1)/(kappa+1). Sources: docs/theory.md. Since 0.1.0. */
double mfv_hertz_half_width(double normal_force, double radius, double shear_modulus, double kolosov_constant);
double mfv_hertz_pressure(double x, double normal_force, double half_width);
double mfv_flat_punch_pressure(double x, double normal_force, double half_width);
double mfv_spence_stick_ratio(double friction_coefficient, double beta);
double mfv_spence_cylinder_shear(double x, double normal_force, double half_width, double friction_coefficient, double beta);
double mfv_spence_flat_punch_shear(double x, double normal_force, double half_width, double friction_coefficient, double beta);
double mfv_mindlin_stick_ratio(double tangential_force, double normal_force, double friction_coefficient);
double mfv_mindlin_shear(double x, double tangential_force, double normal_force, double half_width, double friction_coefficient);
double mfv_mindlin_dissipation(double tangential_force, double normal_force, double half_width, double radius,
                               double friction_coefficient);

/* Pin in a bore of one material in plane strain, without friction (Persson): force at which the contact reaches half_angle
 * [radians] to either side; clearance: by how much the bore's radius is larger. NaN beyond some 85 degrees. Contact arc
 * 2a/R [radians] of a disk on a rigid plane, plane strain, without friction, at which it yields (Table 4.1). Since 0.1.0. */
double mfv_persson_force(double half_angle, double clearance, double youngs_modulus, double poisson_ratio);
double mfv_yield_contact_arc(double youngs_modulus, double poisson_ratio, double yield_strength);

#ifdef __cplusplus
}
#endif
#endif
