/* The calls of include/mfv.h that have a handle: each looks the handle up, keeps others off what it is of, and goes on in mfv_c.f90.
 * There the same call has the object in place of the handle, and `_unguarded` after its name. */
#include "handles.h"
#include <mfv.h>

#define WITHOUT_BRACKETS(...) __VA_ARGS__

/* A call on one handle. `parameters`, `arguments`: those behind it, in brackets. */
#define GUARD(name, kind, sort, use, parameters, arguments)                \
  int name##_unguarded(void *object, WITHOUT_BRACKETS parameters);         \
  int name(kind handle, WITHOUT_BRACKETS parameters) {                     \
    void *object = NULL;                                                   \
    int status = mfv_handle_enter(handle, sort, use, &object);             \
    if (status != MFV_COMPLETE) return status;                             \
    status = name##_unguarded(object, WITHOUT_BRACKETS arguments);         \
    mfv_handle_leave(handle);                                              \
    return status;                                                         \
  }

#define GUARD_SCENE(name, parameters, arguments) GUARD(name, mfv_scene *, MFV_SORT_SCENE, MFV_ALONE, parameters, arguments)
/* Calls that only ask may change what is kept for the next question, and the message. */
#define GUARD_CASE(name, parameters, arguments) GUARD(name, mfv_case *, MFV_SORT_CASE, MFV_ALONE, parameters, arguments)
#define GUARD_QUESTION(name, parameters, arguments) \
  GUARD(name, const mfv_case *, MFV_SORT_CASE, MFV_ALONE, parameters, arguments)

GUARD_SCENE(mfv_scene_set_text, (const char *key, const char *value), (key, value))
GUARD_SCENE(mfv_scene_set_real, (const char *key, double value), (key, value))
GUARD_SCENE(mfv_scene_set_reals, (const char *key, const double *values, size_t count), (key, values, count))
GUARD_SCENE(mfv_scene_set_integer, (const char *key, int value), (key, value))
GUARD_SCENE(mfv_scene_set_logical, (const char *key, int value), (key, value))
GUARD_SCENE(mfv_scene_remove, (const char *key), (key))
GUARD_SCENE(mfv_scene_make_room, (const char *key), (key))
GUARD_SCENE(mfv_scene_set_data, (const char *file, const char *dataset, size_t rows, size_t columns, const double *values),
            (file, dataset, rows, columns, values))
GUARD(mfv_scene_text, const mfv_scene *, MFV_SORT_SCENE, MFV_READING, (char *buffer, size_t size, size_t *length),
      (buffer, size, length))

GUARD_CASE(mfv_advance, (const mfv_step *step), (step))
GUARD_CASE(mfv_tangent, (int motions, const double *direction, double *tangent), (motions, direction, tangent))
GUARD_CASE(mfv_observe, (mfv_observer observer, void *user), (observer, user))
GUARD_CASE(mfv_stress, (int body, int step, size_t count, const double *x, const double *y, double *stresses),
           (body, step, count, x, y, stresses))
GUARD_CASE(mfv_largest_von_mises, (int body, int step, double *place), (body, step, place))
GUARD_CASE(mfv_largest_tension, (int body, int step, double *place), (body, step, place))
GUARD_CASE(mfv_stress_under,
           (int body, size_t nodes, const double *arc, const double *width, const double *pressure, const double *shear,
            const double *contact_edge, const double *stick_edge, size_t count, const double *x, const double *y, double *stresses,
            double *place, double *tension),
           (body, nodes, arc, width, pressure, shear, contact_edge, stick_edge, count, x, y, stresses, place, tension))
GUARD_CASE(mfv_write, (const char *path), (path))
GUARD_QUESTION(mfv_get_loads, (mfv_loads *loads), (loads))
GUARD_QUESTION(mfv_field_count, (size_t *count), (count))
GUARD_QUESTION(mfv_field_path, (size_t index, char *buffer, size_t size), (index, buffer, size))
GUARD_QUESTION(mfv_field_info,
               (const char *path, size_t *count, int *is_integer, int *along, char *unit, size_t unit_size, char *description,
                size_t description_size),
               (path, count, is_integer, along, unit, unit_size, description, description_size))
GUARD_QUESTION(mfv_attribute_name, (size_t index, char *buffer, size_t size), (index, buffer, size))
GUARD_QUESTION(mfv_attribute, (const char *name, char *buffer, size_t size, size_t *length), (name, buffer, size, length))
GUARD_QUESTION(mfv_copy_real, (const char *path, double *values, size_t count), (path, values, count))
GUARD_QUESTION(mfv_copy_integer, (const char *path, int32_t *values, size_t count), (path, values, count))
GUARD(mfv_message, const mfv_case *, MFV_SORT_CASE, MFV_READING, (char *buffer, size_t size), (buffer, size))

int mfv_run_unguarded(void *object);
int mfv_run(mfv_case *handle) {
  void *object = NULL;
  int status = mfv_handle_enter(handle, MFV_SORT_CASE, MFV_ALONE, &object);
  if (status != MFV_COMPLETE) return status;
  status = mfv_run_unguarded(object);
  mfv_handle_leave(handle);
  return status;
}

void mfv_scene_free_unguarded(void *object);
void mfv_free_unguarded(void *object);
void mfv_state_free_unguarded(void *object);

/* Free what a handle is of, and put NULL in its place; what another call uses stays. */
#define FREE(name, kind, sort)                                             \
  int name(kind **slot) {                                                  \
    void *object = NULL;                                                   \
    if (slot == NULL || *slot == NULL) return MFV_COMPLETE;                \
    int status = mfv_handle_enter(*slot, sort, MFV_ALONE, &object);        \
    if (status == MFV_IN_USE) return status;                               \
    if (status == MFV_COMPLETE) {                                          \
      mfv_handle_withdraw(*slot);                                          \
      name##_unguarded(object);                                            \
    }                                                                      \
    *slot = NULL;                                                          \
    return status;                                                         \
  }

FREE(mfv_scene_free, mfv_scene, MFV_SORT_SCENE)
FREE(mfv_free, mfv_case, MFV_SORT_CASE)
FREE(mfv_state_free, mfv_state, MFV_SORT_STATE)

/* The handle of an object that was made with `status`; without memory for one the object is freed. */
static int issue(mfv_sort sort, int status, void *object, void (*destroy)(void *), void **handle) {
  *handle = NULL;
  if (status != MFV_COMPLETE) return status;
  *handle = mfv_handle_issue(sort, object);
  if (*handle != NULL) return MFV_COMPLETE;
  destroy(object);
  return MFV_BAD_HANDLE;
}

static int issue_scene(int status, void *object, mfv_scene **scene) {
  void *handle = NULL;
  if (scene == NULL) return status;
  status = issue(MFV_SORT_SCENE, status, object, mfv_scene_free_unguarded, &handle);
  *scene = handle;
  return status;
}

static int issue_case(int status, void *object, mfv_case **slot) {
  void *handle = NULL;
  if (slot == NULL) return status;
  status = issue(MFV_SORT_CASE, status, object, mfv_free_unguarded, &handle);
  *slot = handle;
  return status;
}

int mfv_scene_create_unguarded(void **object);
int mfv_scene_create(mfv_scene **scene) {
  void *object = NULL;
  int status = mfv_scene_create_unguarded(scene == NULL ? NULL : &object);
  return issue_scene(status, object, scene);
}

int mfv_scene_from_text_unguarded(const char *text, const char *name, void **object, char *message, size_t message_size);
int mfv_scene_from_text(const char *text, const char *name, mfv_scene **scene, char *message, size_t message_size) {
  void *object = NULL;
  int status = mfv_scene_from_text_unguarded(text, name, scene == NULL ? NULL : &object, message, message_size);
  return issue_scene(status, object, scene);
}

int mfv_create_unguarded(const void *scene, int status, void **object, char *message, size_t message_size);
int mfv_create(const mfv_scene *scene, mfv_case **handle, char *message, size_t message_size) {
  void *given = NULL, *object = NULL;
  int found = mfv_handle_enter(scene, MFV_SORT_SCENE, MFV_READING, &given);
  int status = mfv_create_unguarded(given, found, handle == NULL ? NULL : &object, message, message_size);
  if (found == MFV_COMPLETE) mfv_handle_leave(scene);
  return issue_case(status, object, handle);
}

int mfv_create_from_file_unguarded(const char *path, void **object, char *message, size_t message_size);
int mfv_create_from_file(const char *path, mfv_case **handle, char *message, size_t message_size) {
  void *object = NULL;
  int status = mfv_create_from_file_unguarded(path, handle == NULL ? NULL : &object, message, message_size);
  return issue_case(status, object, handle);
}

int mfv_create_from_text_unguarded(const char *text, const char *name, void **object, char *message, size_t message_size);
int mfv_create_from_text(const char *text, const char *name, mfv_case **handle, char *message, size_t message_size) {
  void *object = NULL;
  int status = mfv_create_from_text_unguarded(text, name, handle == NULL ? NULL : &object, message, message_size);
  return issue_case(status, object, handle);
}

int mfv_copy_unguarded(const void *object, void **copy);
int mfv_copy(const mfv_case *handle, mfv_case **copy) {
  void *object = NULL, *other = NULL;
  if (copy == NULL) return MFV_BAD_ARGUMENT;
  *copy = NULL;
  int status = mfv_handle_enter(handle, MFV_SORT_CASE, MFV_READING, &object);
  if (status != MFV_COMPLETE) return status;
  status = mfv_copy_unguarded(object, &other);
  mfv_handle_leave(handle);
  return issue_case(status, other, copy);
}

/* What became of the state's handle is told to the case, whose message it is. */
int mfv_save_unguarded(void *object, int found, void **state);
int mfv_restore_unguarded(void *object, int found, const void *state);

/* `slot`: of the state, or NULL; a new state is made where it holds NULL. */
static int save(void *object, mfv_state **slot) {
  void *kept = NULL;
  if (slot == NULL) return mfv_save_unguarded(object, MFV_COMPLETE, NULL);
  if (*slot == NULL) {
    int status = mfv_save_unguarded(object, MFV_COMPLETE, &kept);
    void *handle = NULL;
    status = issue(MFV_SORT_STATE, status, kept, mfv_state_free_unguarded, &handle);
    *slot = handle;
    return status;
  }
  int found = mfv_handle_enter(*slot, MFV_SORT_STATE, MFV_ALONE, &kept);
  int status = mfv_save_unguarded(object, found, &kept);
  if (found == MFV_COMPLETE) mfv_handle_leave(*slot);
  return status;
}

int mfv_save(const mfv_case *handle, mfv_state **state) {
  void *object = NULL;
  int status = mfv_handle_enter(handle, MFV_SORT_CASE, MFV_ALONE, &object);
  if (status != MFV_COMPLETE) return status;
  status = save(object, state);
  mfv_handle_leave(handle);
  return status;
}

int mfv_restore(mfv_case *handle, const mfv_state *state) {
  void *object = NULL, *kept = NULL;
  int status = mfv_handle_enter(handle, MFV_SORT_CASE, MFV_ALONE, &object);
  if (status != MFV_COMPLETE) return status;
  int found = mfv_handle_enter(state, MFV_SORT_STATE, MFV_READING, &kept);
  status = mfv_restore_unguarded(object, found, kept);
  if (found == MFV_COMPLETE) mfv_handle_leave(state);
  mfv_handle_leave(handle);
  return status;
}
