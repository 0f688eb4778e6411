/* MFV: two-dimensional frictional elastic contact by the Method of First Violation. C interface.
 *
 * Create a case from a scene that is built by calls, or from a namelist text or file (docs/namelist.md); run it, or advance it step
 * by step; then read its fields by their paths in the result file (docs/file-format.md), such as "state/pressure". Scales, which the
 * file repeats in every group, are only available as "mesh/x", "history/record", "cycles/cycle" and "patches/patch".
 *
 * Units: any consistent set; forces and energies per unit thickness. Every call returns a status; mfv_message explains that of a
 * case, mfv_create what is wrong with a scene. Warnings are the attribute "warnings" of a case (mfv_attribute).
 * The library never prints and never stops the process. Handles are independent of each other. Only one call at a time can use a
 * handle: others return MFV_IN_USE and do nothing (mfv_write in two threads at once needs a thread-safe HDF5, as Debian's is).
 * A handle that is null, freed, of another kind or invalid always gives MFV_BAD_HANDLE: handles are not addresses and are never
 * reused. Texts are copied to the caller's buffer of the given size, truncated if necessary, and always null-terminated.
 * Structures begin with their size: later versions may append members and still accept the shorter structures.
 */
#ifndef MFV_H
#define MFV_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Outcomes of calls and runs; mfv_status.def lists them. */
typedef enum mfv_status {
#define MFV_STATUS(name, code, exit_code, outcome, explanation) name = code,
#include "mfv_status.def"
#undef MFV_STATUS
  MFV_STATUS_COUNT
} mfv_status;

/* Motions of the upper body, bulk stresses of either body, their interference, and how many there are: indices of the arrays below.
 * Each has a displacement and a force:
 *   MFV_APPROACH  approach [length];                      normal force P [force/length], >= 0 except in a neat fit
 *   MFV_SHIFT     shift [length], to the right;           tangential force Q [force/length], on the lower body to the right
 *   MFV_ROTATION  rotation [radians], counterclockwise;   moment M [force], counterclockwise, about the centre of rotation
 *   MFV_LOWER_BULK_STRESS, MFV_UPPER_BULK_STRESS
 *                 in place of a displacement a bulk stress: a uniform stress sigma_xx [force/length^2], positive in tension, of an
 *                 elastic body that deforms like a half-plane. Prescribe it with MFV_DISPLACEMENT. Its force is the area [length^2]
 *                 by which the shear tractions shorten the body. Since 0.10.0.
 *   MFV_INTERFERENCE
 *                 distance by which one body is larger than its place [length], >= 0, which closes all gaps: of a disk in a hole of
 *                 its radius, or between bodies whose approach is prescribed. Prescribe it with MFV_DISPLACEMENT. Its force is the
 *                 sum of the pressure along the surface [force/length]. Since 0.10.0.
 * Later versions may add motions. Arrays have MFV_MOTIONS members; the library refuses structures of another size: compile
 * again. */
enum { MFV_APPROACH = 0, MFV_SHIFT = 1, MFV_ROTATION = 2, MFV_LOWER_BULK_STRESS = 3, MFV_UPPER_BULK_STRESS = 4,
       MFV_INTERFERENCE = 5, MFV_MOTIONS = 6 };

/* Control of a motion in a step: hold its load, or prescribe its force or its displacement. */
enum { MFV_KEEP = 0, MFV_FORCE = 1, MFV_DISPLACEMENT = 2 };

/* A scene that is being built: bodies, mesh, friction, solver, steps. Opaque. */
typedef struct mfv_scene mfv_scene;

/* A case with its state. Opaque. */
typedef struct mfv_case mfv_case;

/* A saved state, to be restored. Opaque. */
typedef struct mfv_state mfv_state;

/* One step: loads change linearly from the present ones to the targets. Set every member; start from MFV_STEP_INIT. */
typedef struct mfv_step {
  size_t size;                /* sizeof(mfv_step) */
  double target[MFV_MOTIONS]; /* force or displacement of each motion, as its control says */
  double steady_tolerance;    /* cycles end early when the tractions after two successive cycles differ by less than this
                                 fraction of the largest traction; 0: never */
  int control[MFV_MOTIONS];   /* MFV_KEEP, MFV_FORCE or MFV_DISPLACEMENT */
  int friction;               /* 0: friction off during this step */
  int cycles;                 /* 0: load to the targets; n: load to the targets and back n times */
  int relative;               /* 1: targets are increments of the present loads */
  int unused[2];              /* 0 */
} mfv_step;
#define MFV_STEP_INIT {sizeof(mfv_step), {0.0, 0.0, 0.0, 0.0, 0.0, 0.0}, 0.0, \
                       {MFV_KEEP, MFV_KEEP, MFV_KEEP, MFV_KEEP, MFV_KEEP, MFV_KEEP}, \
                       1, 0, 0, {0, 0}}

/* Version of the library, such as "0.1.0". Since 0.1.0. */
int mfv_version(char *buffer, size_t size);

/* Whether the library was built with a feature (*there: 1 or 0): "hdf5" result files and matrix bodies from files.
 * MFV_BAD_ARGUMENT for a feature that no version has. Since 0.1.0. */
int mfv_has_feature(const char *feature, int *there);

/* Name of a status in words, and its explanation. MFV_BAD_ARGUMENT for a code not in the list. Since 0.1.0. */
int mfv_status_text(int status, char *outcome, size_t outcome_size, char *explanation, size_t explanation_size);

/* Properties of a key of the namelist, such as "friction%mu": whether it takes integers, its unit in terms of length and force
 * ("" for none), and description; every out argument may be NULL. MFV_BAD_ARGUMENT for an unknown key. Since 0.1.0. */
int mfv_key_info(const char *key, int *is_integer, char *unit, size_t unit_size, char *description, size_t description_size);

/* Name, unit in terms of length and force, and description of observable `index` (from 0) of those that a case can have as fields
 * "observables/NAME". Each buffer may be NULL. MFV_BAD_ARGUMENT beyond the last. Since 0.1.0. */
int mfv_observable_info(size_t index, char *name, size_t name_size, char *unit, size_t unit_size, char *description,
                        size_t description_size);

/* An empty scene. Since 0.1.0. */
int mfv_scene_create(mfv_scene **scene);

/* A scene from a namelist text, to be changed by the calls below. `name`: its name in messages, and the path to which file names in
 * it are relative; may be NULL. On failure *scene is NULL and `message`, which may be NULL, says why. Since 0.1.0. */
int mfv_scene_from_text(const char *text, const char *name, mfv_scene **scene, char *message, size_t message_size);

/* Set a key of docs/namelist.md, or change it. `key`: group and key, such as "friction%mu"; groups that may be repeated have a
 * number, from 1: "body(1)%shape" (lower body), "body(2)%radius" (upper body), "step(1)%normal_force". mfv_create checks kinds,
 * ranges and combinations (a force and a displacement in one step); its message names group, key, value and what would be right.
 * The calls here fail for a null argument, an unknown key and a value that is not finite; mfv_create then fails as well.
 * "dundurs_beta" can be set like a key, to a number from -0.5 to 0.5: both bodies get materials with Dundurs' parameter beta and
 * Poisson's ratio 0, and the same mutual compliance as before. Since 0.1.0. */
int mfv_scene_set_text(mfv_scene *scene, const char *key, const char *value);
int mfv_scene_set_real(mfv_scene *scene, const char *key, double value);
int mfv_scene_set_reals(mfv_scene *scene, const char *key, const double *values, size_t count);
int mfv_scene_set_integer(mfv_scene *scene, const char *key, int value);
int mfv_scene_set_logical(mfv_scene *scene, const char *key, int value);

/* Remove a key, such as tangential_force before shift is set. Since 0.1.0. */
int mfv_scene_remove(mfv_scene *scene, const char *key);

/* Remove a key and its alternatives: tangential_force, force_ratio and shift, for example, if any of them is named.
 * Since 0.1.0. */
int mfv_scene_make_room(mfv_scene *scene, const char *key);

/* Data in memory instead of a file: they are used for file='NAME' or mu_file='NAME' in the scene if `file` is NAME. Each column of
 * a text file is a dataset with one column: "x" and "height" of a profile, "x" and "mu" (or "mu_static" and "mu_kinetic") of
 * coefficients of friction; a height may be NaN, no value. Matrix bodies have the datasets of their HDF5 file: "x", "gap", "width",
 * and "compliance" or "stiffness" (values[row*columns + column]). Values are copied. Since 0.1.0. */
int mfv_scene_set_data(mfv_scene *scene, const char *file, const char *dataset, size_t rows, size_t columns,
                       const double *values);

/* The scene as a namelist text. `length`: its characters, without the terminating null. `buffer` and `length` may be NULL.
 * Since 0.1.0. */
int mfv_scene_text(const mfv_scene *scene, char *buffer, size_t size, size_t *length);

/* Free a scene and set *scene to NULL. Safe on NULL. Since 0.1.0. */
int mfv_scene_free(mfv_scene **scene);

/* Create a case from a scene, which may be freed or changed afterwards; from a namelist file; or from a text (`name`: as in
 * mfv_scene_from_text). If mfv_advance is to apply the loads the case needs no &step; then set mesh%half_width: without a step
 * there is no load from which to choose the mesh (it begins small and grows). On failure *handle is NULL and `message`, which may
 * be NULL, says why. Since 0.1.0. */
int mfv_create(const mfv_scene *scene, mfv_case **handle, char *message, size_t message_size);
int mfv_create_from_file(const char *path, mfv_case **handle, char *message, size_t message_size);
int mfv_create_from_text(const char *text, const char *name, mfv_case **handle, char *message, size_t message_size);

/* An independent copy of a case, with its scene, state and history but without the observer. Since 0.1.0. */
int mfv_copy(const mfv_case *handle, mfv_case **copy);

/* Free a case and set *handle to NULL. Safe on NULL. Since 0.1.0. */
int mfv_free(mfv_case **handle);

/* Run the steps of the case that have not been run (steps of mfv_advance do not count). Does not write the result file of &output:
 * see mfv_write. Returns MFV_COMPLETE, or why the load history ended early; the state is then the last one reached. Since 0.1.0. */
int mfv_run(mfv_case *handle);

/* Apply one more step, independent of the steps of the case. Returns as mfv_run. Since 0.1.0. */
int mfv_advance(mfv_case *handle, const mfv_step *step);

/* Message of the last call on this handle that failed, or of the outcome of the run. Since 0.1.0. */
int mfv_message(const mfv_case *handle, char *buffer, size_t size);

/* Loads and motions of the present state. */
typedef struct mfv_loads {
  size_t size;                /* sizeof(mfv_loads) */
  double force[MFV_MOTIONS];  /* of every motion: P, Q, M, areas, closing force */
  double motion[MFV_MOTIONS]; /* displacements of the upper body: approach, shift, rotation; bulk stresses; interference */
  double dissipation;         /* energy dissipated by friction so far [force] */
  int contact_nodes, stick_nodes, slip_nodes;
  int events;                 /* number of loads at which nodes have changed their status */
  int linear_solves;          /* so far */
  int unused;                 /* 0 */
} mfv_loads;
#define MFV_LOADS_INIT {sizeof(mfv_loads), {0.0, 0.0, 0.0, 0.0, 0.0, 0.0}, {0.0, 0.0, 0.0, 0.0, 0.0, 0.0}, 0.0, 0, 0, 0, 0, 0, 0}

/* Present loads and motions; cheaper than the fields of "summary". Since 0.1.0. */
int mfv_get_loads(const mfv_case *handle, mfv_loads *loads);

/* Consistent tangent at the present state: tangent[i*motions + j] is the derivative of the force of motion i with respect to the
 * displacement of motion j, such as i = MFV_SHIFT, j = MFV_APPROACH. motions: 2 (the rotation is held, also if a moment is
 * prescribed), 3 (with it) or MFV_MOTIONS. It is exact up to the next node that changes its status. The tangent depends on the
 * direction of loading: it is that of further motion in `direction` (an array of `motions` values, such as {0, 1} for a shift to
 * the right, of any length; with friction, if the scene has any); if `direction` is NULL, that of the last increment, with
 * unchanged node statuses, except that nodes pressed without friction stick if the scene has friction. Zero without contact and,
 * for the shift, without friction or in gross sliding, where the tangential force follows the normal one. After a step that
 * prescribed two motions at once, it differs across the direction of that step from the derivative of the end of the step by the
 * order of the step (docs/theory.md). The state does not change. MFV_BAD_ARGUMENT if the contact does not determine the tangent; if
 * loading in that direction is impossible, the status of mfv_advance, such as MFV_NO_CONTINUATION. Since 0.1.0. */
int mfv_tangent(mfv_case *handle, int motions, const double *direction, double *tangent);

/* Derive all further states with respect to parameters, by their names separated by blanks: real keys of &body and &friction, such
 * as "body(2)%radius friction%mu", before the first step; targets of steps to come, such as "step(2)%shift", or "shift" for that of
 * the next step. They replace those of an earlier call ("": none); the state so far is taken to be independent of them. The
 * derivatives are propagated through all events, at one linear solve for each event and parameter (not counted in mfv_loads). The
 * mesh and all other targets, also relative ones, are held. MFV_BAD_ARGUMENT for an unknown or passed parameter, with large
 * increments, the conventional algorithm, wear, and laws other than Coulomb's. Since 0.10.0. */
int mfv_differentiate(mfv_case *handle, const char *parameters);

/* Derivatives of the present state with respect to parameter `index` (from 0): force, motion and dissipation of `loads`, and
 * pressure and shear traction of the nodes, whose number is `count`. linear_solves of `loads` are those for derivatives so far, events
 * the number of loads at which several nodes changed their status together but would not at another value of the parameter, such as a
 * moment in a symmetric contact: if it is not 0 the derivative is approximate. The other counts are 0. loads, pressure and shear may be
 * NULL. Units: of these over that of the parameter. MFV_BAD_ARGUMENT if there are none, as after a step that ended early. Since
 * 0.10.0. */
int mfv_derivative(const mfv_case *handle, size_t index, mfv_loads *loads, size_t count, double *pressure, double *shear);

/* Save the present state in *state (created if it is NULL, else overwritten), and restore it: the case then continues bit-identically
 * from it, also after an early end. History, steps and cycles are restored as well; error bars are discarded. With history='none'
 * and states='none' in &output, saved states can be restored in any order, in this case and its copies; otherwise only a state that
 * precedes the present one in its load history (others: MFV_BAD_ARGUMENT). A state may outlive its case. Since 0.1.0. */
int mfv_save(const mfv_case *handle, mfv_state **state);
int mfv_restore(mfv_case *handle, const mfv_state *state);

/* Free a saved state and set *state to NULL. Safe on NULL. Since 0.1.0. */
int mfv_state_free(mfv_state **state);

/* Progress reported to an observer after every increment of the load. */
typedef struct mfv_progress {
  size_t size;                /* sizeof(mfv_progress) of the library */
  double fraction;            /* of this load segment */
  int segment, segments;      /* number of the load segment, from 1, and number of all segments */
  int contact_nodes, stick_nodes;
  double force[MFV_MOTIONS];  /* as in mfv_loads */
  double motion[MFV_MOTIONS]; /* the same */
} mfv_progress;
typedef int (*mfv_observer)(const mfv_progress *progress, void *user);

/* Call `observer` with `user` after every increment (NULL: no observer). It runs in the thread of mfv_run or mfv_advance; calls on
 * this handle, even mfv_free, return MFV_IN_USE in it. A return value other than 0 ends the run: the outcome is then
 * MFV_INTERRUPTED, and mfv_advance can continue from the last state (mfv_run cannot: its step is incomplete). Do not leave it by a
 * C++ exception or longjmp: the handle would stay in use. Since 0.1.0. */
int mfv_observe(mfv_case *handle, mfv_observer observer, void *user);

/* An observer for mfv_observe that ends the run when the int at `user`, which another thread may set, is not 0. Since 0.1.0. */
int mfv_stop_when_set(const mfv_progress *progress, void *user);

/* Number of fields of the case now, and the path of field `index` (from 0), such as "history/shift". Since 0.1.0. */
int mfv_field_count(const mfv_case *handle, size_t *count);
int mfv_field_path(const mfv_case *handle, size_t index, char *buffer, size_t size);

/* The dimension along which the values of a field are listed. */
enum { MFV_ALONG_NOTHING = 0, MFV_ALONG_NODES = 1, MFV_ALONG_RECORDS = 2, MFV_ALONG_COMPANIONS = 3, MFV_ALONG_CYCLES = 4,
       MFV_ALONG_PATCHES = 5 };

/* Properties of the field at `path`: number of values (1 for a scalar), whether they are integers, their dimension, unit and
 * description; every out argument may be NULL. Since 0.1.0. */
int mfv_field_info(const mfv_case *handle, const char *path, size_t *count, int *is_integer, int *along,
                   char *unit, size_t unit_size, char *description, size_t description_size);

/* Attributes of the result, texts such as title, outcome, plane, input, warnings (a line each) and unresolved (names of observables
 * that the mesh does not resolve): name of attribute `index` (from 0; MFV_BAD_ARGUMENT beyond the last), and text of a named one.
 * `length`: its characters, without the terminating null. `buffer` and `length` may be NULL. Since 0.1.0. */
int mfv_attribute_name(const mfv_case *handle, size_t index, char *buffer, size_t size);
int mfv_attribute(const mfv_case *handle, const char *name, char *buffer, size_t size, size_t *length);

/* Copy the values of a field; `count` must be its number of values. Cases with cycles have further fields, which are not listed:
 * "moments/loading/pressure" and "moments/loading/shear", the tractions at the start of the last cycles; the same under
 * "moments/reversal" at the reversal of the last cycle and "moments/return" at its end. Since 0.1.0. */
int mfv_copy_real(const mfv_case *handle, const char *path, double *values, size_t count);
int mfv_copy_integer(const mfv_case *handle, const char *path, int32_t *values, size_t count);

/* The two bodies. */
enum { MFV_LOWER = 0, MFV_UPPER = 1 };

/* Stresses at a point [force/length^2], positive in tension, as in mfv_stress. sigma_zz: out of plane;
 * principal stresses in the plane; three in polar components about the centre of a disk or hole, counterclockwise (NaN in a
 * half-plane); Tresca: the largest difference of the three principal stresses, including sigma_zz; the direction of
 * principal_1 from the x axis, counterclockwise [radians]. */
enum {
  MFV_SIGMA_XX, MFV_SIGMA_YY, MFV_SIGMA_XY, MFV_SIGMA_ZZ, MFV_PRINCIPAL_1, MFV_PRINCIPAL_2, MFV_VON_MISES,
  MFV_SIGMA_RR, MFV_SIGMA_THETATHETA, MFV_SIGMA_RTHETA, MFV_TRESCA, MFV_PRINCIPAL_ANGLE, MFV_STRESS_COUNT
};

/* Stresses inside a body (MFV_LOWER or MFV_UPPER) in the present state (step = 0) or in that of steps/000N (step = N), at
 * the points x[i], y[i] [length], y up from the contact: stresses[i*MFV_STRESS_COUNT + MFV_SIGMA_XX] and so on. NaN
 * outside the body. The largest von Mises stress, found by refinement (in a disk to half its radius): place = {stress, x, y};
 * NaN if it is unbounded, at a sharp corner in contact. The largest tension along the surface: tension likewise; NaN if it is
 * singular (shear acts at a sharp corner of the body); its x and y are NaN if there is no tension. x and y of either are NaN if
 * the bulk stress far from the contact is the largest. stresses (then with count = 0), place and tension may be NULL.
 * MFV_BAD_ARGUMENT for a rigid body or one given by a matrix. Since 0.1.0. */
int mfv_stress(mfv_case *handle, int body, int step, size_t count, const double *x, const double *y, double *stresses,
               double *place, double *tension);

/* The same for tractions given by the caller, such as those of a result file: pressure and shear (on the lower body, to the
 * right) at `nodes` nodes with intervals of the lengths width[] around the positions arc[] along the surface, from left to
 * right without overlap (else MFV_BAD_ARGUMENT). contact_edge, stick_edge: edges of contact and stick zones between the
 * nodes, the left and the right one of each zone in turn, at any nodes in ascending order, NaN at all others
 * (state/contact_edge and state/stick_edge); or NULL: edges of contact are
 * located from the nodal tractions, those of stick zones are not. Tractions are taken to vanish like a square root at the ends
 * of the loaded zone, except where a body of the case ends at a given contact_edge. Others, such as a uniform traction or a flat
 * punch's pressure on a case without that punch, give stresses that are wrong by 3 to 31 % near the surface. bulk_stress: a
 * uniform sigma_xx of the body [force/length^2], 0 for a disk or hole. stresses, place and tension may be NULL. Since 0.1.0.
 * (bulk_stress: since 0.10.0.) */
int mfv_stress_under(mfv_case *handle, int body, size_t nodes, const double *arc, const double *width,
                     const double *pressure, const double *shear, const double *contact_edge, const double *stick_edge,
                     double bulk_stress, size_t count, const double *x, const double *y, double *stresses, double *place, double *tension);

/* Write the result file (HDF5) to `path`, or to the file of &output if `path` is NULL. An existing file is
 * replaced only by a complete one. Since 0.1.0. */
int mfv_write(mfv_case *handle, const char *path);

/* The closed form `name` with `count` arguments; value: NaN outside its domain. MFV_BAD_ARGUMENT for an unknown name or
 * another number of arguments. P, Q: forces per unit thickness; a: contact half-width; mu: coefficient of friction; R: radius; G, E:
 * shear and Young's modulus; nu: Poisson's ratio; kappa: Kolosov's constant; beta: Dundurs' parameter (kappa-1)/(kappa+1); d: datum
 * of the approach. Sources: docs/theory.md.
 *   "hertz_half_width" {P, R, G, kappa}, "hertz_pressure", "flat_punch_pressure" {x, P, a}
 *   "spence_stick_ratio" {mu, beta}, "spence_cylinder_shear", "spence_flat_punch_shear" {x, P, a, mu, beta}
 *   "mindlin_stick_ratio" {Q, P, mu}, "mindlin_shear" {x, Q, P, a, mu}, "mindlin_dissipation" {Q, P, a, R, mu}
 * Two elastically similar cylinders in steady rolling under constant P and Q (Carter 1926). The contact rolls to the right, x is
 * measured from its middle; rolling to the left: shear at -x, -creepage. Creepage: sliding of the upper surface over the lower one
 * per rolled distance. 1/R = 1/R1 + 1/R2. NaN beyond |Q| = mu P.
 *   "carter_creepage" {Q, P, a, R, mu}, "carter_shear" {x, Q, P, a, mu}
 * Bodies of the shape C |x|^n, n from 1 (a wedge with flanks of the angle atan C) to 100, and flat ones of the half-width b with
 * edges of the radius R (Ciavarella, Hills and Monno 1998), pressed, then sheared. Stick ratio: width of the stick zone over that of
 * the contact.
 *   "power_half_width" {P, C, n, G, kappa}, "power_approach" {a, C, n, d}, "power_pressure" {x, P, a, n}
 *   "power_stick_ratio" {Q, P, mu, n}, "power_shear" {x, Q, P, a, mu, n}
 *   "rounded_punch_half_width" {P, b, R, G, kappa}, "rounded_punch_approach" {a, b, R, d}, "rounded_punch_pressure" {x, P, a, b}
 *   "rounded_punch_stick_ratio" {Q, P, mu, a, b}, "rounded_punch_shear" {x, Q, P, a, mu, b}
 * Constants of an anisotropic half-plane below its surface, with the compliances s11, s12, s22, s16, s26, s66 along x and y
 * [length^2/force], by number: 1: A (w by P), 2: At (u by Q), 3: M (between them), 4: B (coupling), docs/theory.md. Two half-planes of
 * one such material in one direction, one with a gap x^2/(2R), pressed without shear, then sheared: m = 1/A, k = M/A of both.
 *   "surface_compliance" {s11, s12, s22, s16, s26, s66, number}
 *   "oblique_half_width" {P, Q, R, m, k}, "oblique_stick_ratio" {Q, P, mu, k} (since 0.10.0)
 * A wave D (1 - cos(2 pi x/l)) on a half-plane that repeats with it, pressed, then sheared before full contact; forces of a period.
 *   "wave_half_width" {P, D, l, G, kappa}, "wave_pressure" {x, P, D, l, G, kappa}, "wave_stick_ratio" {Q, P, mu, D, l, G, kappa}
 *   (since 0.10.0)
 * Pin in a bore of one material in plane strain, without friction (Persson): force at which the contact reaches half_angle
 * [radians] to either side; clearance: by how much the bore's radius is larger. NaN beyond about 85 degrees. Contact arc
 * 2a/R [radians] of a disk on a rigid plane, plane strain, without friction, at which it yields (Table 4.1).
 *   "persson_force" {half_angle, clearance, E, nu}, "yield_contact_arc" {E, nu, yield strength}
 * Since 0.1.0. */
int mfv_reference(const char *name, size_t count, const double *arguments, double *value);

#ifdef __cplusplus
}
#endif
#endif
