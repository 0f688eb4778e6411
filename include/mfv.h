/* MFV: two-dimensional frictional elastic contact by the Method of First Violation. C interface.
 *
 * A case is made from a scene that is built by calls, or from a namelist text or file (docs/namelist.md); run, or advanced
 * step by step; and asked for its fields by the same paths as in the result file (docs/file-format.md), "state/pressure"
 * for one; the scales that the file repeats in every group are "mesh/x", "history/record", "cycles/cycle" and "patches/patch" alone.
 *
 * Units: any consistent set; forces and energies per unit thickness. Every call returns a status; mfv_message tells more.
 * The library never prints and never stops the process. Handles are independent of each other; a handle is used by one call at a
 * time, and others that come meanwhile return MFV_IN_USE and do nothing (mfv_write in two threads at once needs an HDF5 that is
 * thread-safe, as Debian's is). A handle that is null, was freed, is of another sort or is no handle at all is told by
 * MFV_BAD_HANDLE, always: handles are numbers that are looked up and never come again, not addresses. Texts go
 * out through the caller's buffer with its size, cut where they do not fit, always null-terminated. Structures begin with
 * their size: later versions may append members, and take the shorter ones of programs that do not know them.
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

/* Motions of the upper body, and how many there are: indices of the arrays below. Each has a displacement and a force:
 *   MFV_APPROACH  approach [length];                      normal force P >= 0 [force/length]
 *   MFV_SHIFT     shift [length], to the right;           tangential force Q [force/length], on the lower body to the right
 *   MFV_ROTATION  rotation [radians], counterclockwise;   moment M [force], counterclockwise, about the centre of rotation
 * Later versions may add motions: arrays have MFV_MOTIONS members, and the size of a structure says how many a program knows. */
enum { MFV_APPROACH = 0, MFV_SHIFT = 1, MFV_ROTATION = 2, MFV_MOTIONS = 3 };

/* What a step does with a motion: keep its load, or prescribe its force or its displacement. */
enum { MFV_KEEP = 0, MFV_FORCE = 1, MFV_DISPLACEMENT = 2 };

/* A scene that is being built: bodies, mesh, friction, solver, steps. Opaque. */
typedef struct mfv_scene mfv_scene;

/* A case with its state. Opaque. */
typedef struct mfv_case mfv_case;

/* A state that was kept, to come back to. Opaque. */
typedef struct mfv_state mfv_state;

/* One step: targets are reached linearly from the loads now. Set every member; start from MFV_STEP_INIT. */
typedef struct mfv_step {
  size_t size;                /* sizeof(mfv_step) */
  double target[MFV_MOTIONS]; /* force or displacement of each motion, as its control says */
  double steady_tolerance;    /* cycles end early when the state after two in a row is the same to within this part of the
                                 largest traction; 0: never */
  int control[MFV_MOTIONS];   /* MFV_KEEP, MFV_FORCE or MFV_DISPLACEMENT */
  int friction;               /* 0: friction off during this step */
  int cycles;                 /* 0: go to the targets; n: go there and back n times */
  int relative;               /* 1: targets are increments, added to the loads now */
  int unused[2];              /* 0 */
} mfv_step;
#define MFV_STEP_INIT {sizeof(mfv_step), {0.0, 0.0, 0.0}, 0.0, {MFV_KEEP, MFV_KEEP, MFV_KEEP}, 1, 0, 0, {0, 0}}

/* Version of the library, such as "0.1.0". Since 0.1.0. */
int mfv_version(char *buffer, size_t size);

/* Whether the library was built with a feature (*there: 1 or 0): "hdf5" result files and matrix bodies from files.
 * MFV_BAD_ARGUMENT for a feature that no version has. Since 0.1.0. */
int mfv_has_feature(const char *feature, int *there);

/* Outcome of a status in words, and a clause that explains it. MFV_BAD_ARGUMENT for a code not in the list. Since 0.1.0. */
int mfv_status_text(int status, char *outcome, size_t outcome_size, char *explanation, size_t explanation_size);

/* Of a key of the namelist, such as "friction%mu": whether it takes whole numbers, its unit in terms of length and force ("" for
 * none), and description; every out argument may be NULL. MFV_BAD_ARGUMENT for what is no key. Since 0.1.0. */
int mfv_key_info(const char *key, int *is_integer, char *unit, size_t unit_size, char *description, size_t description_size);

/* Name, unit in terms of length and force, and description of observable `index` (from 0) of those that a case can have as fields
 * "observables/NAME". Each buffer may be NULL. MFV_BAD_ARGUMENT beyond the last. Since 0.1.0. */
int mfv_observable_info(size_t index, char *name, size_t name_size, char *unit, size_t unit_size, char *description,
                        size_t description_size);

/* An empty scene. Since 0.1.0. */
int mfv_scene_create(mfv_scene **scene);

/* A scene from a namelist text, to be changed by the calls below (`name`: what messages call it; files named in it are looked
 * for beside it; may be NULL). On failure *scene is NULL and `message`, which may be NULL, tells why. Since 0.1.0. */
int mfv_scene_from_text(const char *text, const char *name, mfv_scene **scene, char *message, size_t message_size);

/* Give a key of docs/namelist.md a value. `key`: group and key, such as "friction%mu"; of groups that may come more than once
 * with the number, from 1: "body(1)%shape" (below), "body(2)%radius" (above), "step(1)%normal_force". A key that is there
 * gets the new value. Kinds, ranges and combinations (a force and a displacement in one step) are checked by mfv_create, with a
 * message that names group, key, value and what is right; a call here fails for a null argument, a name that is none, and
 * a value that is not finite, which mfv_create tells too. "dundurs_beta" can be set like a key, to a number from -0.5 to 0.5: both
 * bodies get materials with Dundurs' parameter beta and Poisson's ratio 0, and the same mutual compliance as before. Since 0.1.0. */
int mfv_scene_set_text(mfv_scene *scene, const char *key, const char *value);
int mfv_scene_set_real(mfv_scene *scene, const char *key, double value);
int mfv_scene_set_reals(mfv_scene *scene, const char *key, const double *values, size_t count);
int mfv_scene_set_integer(mfv_scene *scene, const char *key, int value);
int mfv_scene_set_logical(mfv_scene *scene, const char *key, int value);

/* Take a key out, as if it had never been given a value: tangential_force, say, before shift comes in. Since 0.1.0. */
int mfv_scene_remove(mfv_scene *scene, const char *key);

/* Take a key out and those that it is an alternative to: tangential_force, force_ratio and shift, say, whichever of them is named.
 * Since 0.1.0. */
int mfv_scene_make_room(mfv_scene *scene, const char *key);

/* Data in memory in place of a file that a key names: where the scene says file='NAME' or mu_file='NAME', and data are there
 * for `file` = NAME, they are taken. Columns of a text file are datasets of that many rows and one column: "x" and "height" of
 * a profile, "x" and "mu" (or "mu_static" and "mu_kinetic") of coefficients of friction; matrix bodies have the datasets of
 * their HDF5 file: "x", "gap", "width", and "compliance" or "stiffness" (values[row*columns + column]). Values are copied. Since
 * 0.1.0. */
int mfv_scene_set_data(mfv_scene *scene, const char *file, const char *dataset, size_t rows, size_t columns,
                       const double *values);

/* The scene as a namelist text. `length`: its characters, without the terminating null. `buffer` and `length` may be NULL.
 * Since 0.1.0. */
int mfv_scene_text(const mfv_scene *scene, char *buffer, size_t size, size_t *length);

/* Free a scene and set *scene to NULL. Safe on NULL. Since 0.1.0. */
int mfv_scene_free(mfv_scene **scene);

/* Create a case from a scene, which stays as it is and may be freed or changed afterwards; from a namelist file; or from a
 * text (`name`: as in mfv_scene_from_text). It may have no &step when mfv_advance is to lead the loads; then give
 * mesh%half_width, for without a step there is no load to choose a mesh by (it begins small, and grows). On failure *handle is
 * NULL and `message`, which may be NULL, tells why. Since 0.1.0. */
int mfv_create(const mfv_scene *scene, mfv_case **handle, char *message, size_t message_size);
int mfv_create_from_file(const char *path, mfv_case **handle, char *message, size_t message_size);
int mfv_create_from_text(const char *text, const char *name, mfv_case **handle, char *message, size_t message_size);

/* A case of its own with the same scene, state and history. The observer does not go along. Since 0.1.0. */
int mfv_copy(const mfv_case *handle, mfv_case **copy);

/* Free a case and set *handle to NULL. Safe on NULL. Since 0.1.0. */
int mfv_free(mfv_case **handle);

/* Run the steps of the case that have not been run (steps of mfv_advance do not count). The result file of its &output is not written: see mfv_write.
 * Returns the outcome: MFV_COMPLETE, or why the load history ended early, with the state up to there. Since 0.1.0. */
int mfv_run(mfv_case *handle);

/* Lead the loads through one more step, whatever the steps of the case are. Returns as mfv_run. Since 0.1.0. */
int mfv_advance(mfv_case *handle, const mfv_step *step);

/* Message of the last call on this handle that failed, or of its outcome. Since 0.1.0. */
int mfv_message(const mfv_case *handle, char *buffer, size_t size);

/* Loads and motions of the present state. */
typedef struct mfv_loads {
  size_t size;                /* sizeof(mfv_loads) */
  double force[MFV_MOTIONS];  /* of every motion: P, Q, M */
  double motion[MFV_MOTIONS]; /* displacements of the upper body: approach, shift, rotation */
  double dissipation;         /* energy dissipated by friction so far [force] */
  int contact_nodes, stick_nodes, slip_nodes;
  int events;                 /* loads so far at which nodes changed their status */
  int linear_solves;          /* so far */
  int unused;                 /* 0 */
} mfv_loads;
#define MFV_LOADS_INIT {sizeof(mfv_loads), {0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, 0.0, 0, 0, 0, 0, 0, 0}

/* Loads and motions now, without the cost of a field of "summary". Since 0.1.0. */
int mfv_get_loads(const mfv_case *handle, mfv_loads *loads);

/* Consistent tangent at the present state: tangent[i*motions + j] is the derivative of the force of motion i with respect to the
 * displacement of motion j, such as i = MFV_SHIFT, j = MFV_APPROACH; motions: 2 (the rotation is held, also where a moment is
 * prescribed), or MFV_MOTIONS. It is exact up to the next node that changes its status. Contact and friction have corners: the tangent
 * is the one of motions that go on towards `direction` (motions lengths, such as {0, 1} for a shift to the right; only its
 * direction counts; friction acts, if the scene has any), or, where it is NULL, on the way that led here, every node's status as
 * it is. Across the direction of a step that led two motions at once it differs from the derivative of the step's end by the
 * order of the step (docs/theory.md). The state does not change. MFV_BAD_ARGUMENT where the contact does not determine it; where
 * nothing leads on in that direction what mfv_advance would return, such as MFV_NO_CONTINUATION. Since 0.1.0. */
int mfv_tangent(mfv_case *handle, int motions, const double *direction, double *tangent);

/* Keep the present state in *state (made where it is NULL, else its storage is used again), and come back to it: the case then
 * goes on with the same digits as if nothing had been done in between, also after an early end. History, steps and cycles go
 * back too; error bars are dropped. With history='none' and states='none' in &output any number of kept states can be gone to in any order, in this
 * case and its copies; otherwise only to states on the way that led to the present one (others: MFV_BAD_ARGUMENT). A state may
 * outlive the case that it is from. Since 0.1.0. */
int mfv_save(const mfv_case *handle, mfv_state **state);
int mfv_restore(mfv_case *handle, const mfv_state *state);

/* Free a kept state and set *state to NULL. Safe on NULL. Since 0.1.0. */
int mfv_state_free(mfv_state **state);

/* What an observer is told after every increment of the load. */
typedef struct mfv_progress {
  size_t size;                /* sizeof(mfv_progress) of the library */
  double fraction;            /* of this load segment */
  int segment, segments;      /* number of this part, from 1, and how many there are */
  int contact_nodes, stick_nodes;
  double force[MFV_MOTIONS];  /* as in mfv_loads */
  double motion[MFV_MOTIONS]; /* the same */
} mfv_progress;
typedef int (*mfv_observer)(const mfv_progress *progress, void *user);

/* From now on tell `observer` (NULL: nobody) of every increment, with `user`. It runs in the thread of mfv_run or mfv_advance;
 * calls on this handle return MFV_IN_USE in it, mfv_free too. It ends the run by a value that is not 0: the outcome is then
 * MFV_INTERRUPTED, with the last state in place, from which mfv_advance goes on (mfv_run does not: its step was left in the
 * middle). No C++ exception and no longjmp may leave it: the handle would stay in use for ever. Since 0.1.0. */
int mfv_observe(mfv_case *handle, mfv_observer observer, void *user);

/* An observer to give to mfv_observe: it ends the run when the int at `user` is not 0, which another thread may set. Since 0.1.0. */
int mfv_stop_when_set(const mfv_progress *progress, void *user);

/* Number of fields of the case now, and the path of field `index` (from 0), such as "history/shift". Since 0.1.0. */
int mfv_field_count(const mfv_case *handle, size_t *count);
int mfv_field_path(const mfv_case *handle, size_t index, char *buffer, size_t size);

/* What the values of a field run along. */
enum { MFV_ALONG_NOTHING = 0, MFV_ALONG_NODES = 1, MFV_ALONG_RECORDS = 2, MFV_ALONG_COMPANIONS = 3, MFV_ALONG_CYCLES = 4,
       MFV_ALONG_PATCHES = 5 };

/* Of the field at `path`: number of values (1 for a scalar), whether they are whole numbers, what they run along, unit and
 * description; every out argument may be NULL. Since 0.1.0. */
int mfv_field_info(const mfv_case *handle, const char *path, size_t *count, int *is_integer, int *along,
                   char *unit, size_t unit_size, char *description, size_t description_size);

/* Attributes of the result, texts such as title, outcome, plane or input: name of attribute `index` (from 0;
 * MFV_BAD_ARGUMENT beyond the last), and text of a named one. `length`: its characters, without the terminating null.
 * `buffer` and `length` may be NULL. Since 0.1.0. */
int mfv_attribute_name(const mfv_case *handle, size_t index, char *buffer, size_t size);
int mfv_attribute(const mfv_case *handle, const char *name, char *buffer, size_t size, size_t *length);

/* Copy out the values of a field; `count` must be its number of values. Besides the listed ones there are, where there are
 * cycles, "moments/loading/pressure" and "moments/loading/shear", the tractions where the last cycles began; the same under
 * "moments/reversal" at the far end of the last cycle and "moments/return" at its end. Since 0.1.0. */
int mfv_copy_real(const mfv_case *handle, const char *path, double *values, size_t count);
int mfv_copy_integer(const mfv_case *handle, const char *path, int32_t *values, size_t count);

/* The two bodies. */
enum { MFV_LOWER = 0, MFV_UPPER = 1 };

/* Stresses at a point [force/length^2], positive in tension: what a point has in mfv_stress. sigma_zz: across the plane;
 * principal stresses in the plane; three in polar components about the centre of a disk or hole, counterclockwise (NaN in a
 * half-plane); Tresca: the largest difference of the three principal stresses, sigma_zz among them; the direction of
 * principal_1 from the x axis, counterclockwise [radians]. */
enum {
  MFV_SIGMA_XX, MFV_SIGMA_YY, MFV_SIGMA_XY, MFV_SIGMA_ZZ, MFV_PRINCIPAL_1, MFV_PRINCIPAL_2, MFV_VON_MISES,
  MFV_SIGMA_RR, MFV_SIGMA_THETATHETA, MFV_SIGMA_RTHETA, MFV_TRESCA, MFV_PRINCIPAL_ANGLE, MFV_STRESS_COUNT
};

/* Stresses inside a body (MFV_LOWER or MFV_UPPER) in the present state (step = 0) or in that of steps/000N (step = N), at
 * the points x[i], y[i] [length], y up from the contact: stresses[i*MFV_STRESS_COUNT + MFV_SIGMA_XX] and so on. NaN
 * outside the body. The largest von Mises stress, found by refinement: place = {stress, x, y}. The largest tension along the
 * surface: tension likewise; NaN where it is singular (the surface of a body ends where it carries shear), its x and y where
 * there is none. stresses (then with count = 0), place and tension may be NULL. MFV_BAD_ARGUMENT for a rigid body or one given
 * by a matrix. Since 0.1.0. */
int mfv_stress(mfv_case *handle, int body, int step, size_t count, const double *x, const double *y, double *stresses,
               double *place, double *tension);

/* All of these for tractions of the caller's, such as those of a result file: pressure and shear (on the lower body, to the
 * right) at `nodes` nodes with intervals of the lengths width[] around the positions arc[] along the surface. contact_edge,
 * stick_edge: edges of contact and stick zones between the nodes, the left and the right one of each zone in turn, at any
 * nodes in ascending order, NaN at all others (state/contact_edge and state/stick_edge); or NULL: edges of contact are
 * located from the nodal tractions, those of stick zones are not. stresses, place and tension may be NULL. Since 0.1.0. */
int mfv_stress_under(mfv_case *handle, int body, size_t nodes, const double *arc, const double *width,
                     const double *pressure, const double *shear, const double *contact_edge, const double *stick_edge,
                     size_t count, const double *x, const double *y, double *stresses, double *place, double *tension);

/* Write the result file (HDF5) to `path`, or where the case's &output says when `path` is NULL. An existing file is
 * replaced only by a complete one. Since 0.1.0. */
int mfv_write(mfv_case *handle, const char *path);

/* The closed form `name` with `count` arguments; value: NaN outside its domain. MFV_BAD_ARGUMENT for a name that is none, or with
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
 * Pin in a bore of one material in plane strain, without friction (Persson): force at which the contact reaches half_angle
 * [radians] to either side; clearance: by how much the bore's radius is larger. NaN beyond some 85 degrees. Contact arc
 * 2a/R [radians] of a disk on a rigid plane, plane strain, without friction, at which it yields (Table 4.1).
 *   "persson_force" {half_angle, clearance, E, nu}, "yield_contact_arc" {E, nu, yield strength}
 * Since 0.1.0. */
int mfv_reference(const char *name, size_t count, const double *arguments, double *value);

#ifdef __cplusplus
}
#endif
#endif
