/* The calls of include/mfv.h on a handle: each looks the handle up, blocks other calls on its object, and calls the procedure of
 * the same name with the suffix `_unguarded` in mfv_c.f90, with the object instead of the handle. Calls that create or free handles
 * are in mfv_c.f90. */
#include "handles.h"
#include <mfv.h>

#define GUARD(name, kind, use, parameters, arguments) \
  int name##_unguarded parameters;                    \
  GUARDED(name, kind, use, parameters, name##_unguarded arguments)

#define GUARDED(name, kind, use, parameters, call)                 \
  int name parameters {                                            \
    void *object = NULL;                                           \
    int status = mfv_handle_enter(handle, kind, use, &object);     \
    if (status != MFV_COMPLETE) return status;                     \
    status = call;                                                 \
    mfv_handle_leave(handle);                                      \
    return status;                                                 \
  }

/* Queries also need exclusive use: they may change the message and the cache. */
#define SCENE(name, parameters, arguments) GUARDED(name, MFV_KIND_SCENE, MFV_ALONE, parameters, mfv_scene_change arguments)
#define CASE(name, parameters, arguments) GUARD(name, MFV_KIND_CASE, MFV_ALONE, parameters, arguments)

/* All changes of a scene are one procedure of mfv_c.f90. A double has every value of an int. */
enum { SET_TEXT = 1, SET_REAL, SET_REALS, SET_INTEGER, SET_LOGICAL, SET_DATA, REMOVE_KEY, MAKE_ROOM };
int mfv_scene_change(void *object, int change, const char *key, const char *text, size_t rows, size_t columns, const double *values);

SCENE(mfv_scene_set_text, (mfv_scene *handle, const char *key, const char *value), (object, SET_TEXT, key, value, 0, 0, NULL))
SCENE(mfv_scene_set_real, (mfv_scene *handle, const char *key, double value), (object, SET_REAL, key, NULL, 1, 1, &value))
SCENE(mfv_scene_set_reals, (mfv_scene *handle, const char *key, const double *values, size_t count),
      (object, SET_REALS, key, NULL, count, 1, values))
SCENE(mfv_scene_set_integer, (mfv_scene *handle, const char *key, int value),
      (object, SET_INTEGER, key, NULL, 1, 1, &(double){value}))
SCENE(mfv_scene_set_logical, (mfv_scene *handle, const char *key, int value),
      (object, SET_LOGICAL, key, NULL, 1, 1, &(double){value}))
SCENE(mfv_scene_remove, (mfv_scene *handle, const char *key), (object, REMOVE_KEY, key, NULL, 0, 0, NULL))
SCENE(mfv_scene_make_room, (mfv_scene *handle, const char *key), (object, MAKE_ROOM, key, NULL, 0, 0, NULL))
SCENE(mfv_scene_set_data,
      (mfv_scene *handle, const char *file, const char *dataset, size_t rows, size_t columns, const double *values),
      (object, SET_DATA, file, dataset, rows, columns, values))
GUARD(mfv_scene_text, MFV_KIND_SCENE, MFV_READING, (const mfv_scene *handle, char *buffer, size_t size, size_t *length),
      (object, buffer, size, length))

CASE(mfv_run, (mfv_case *handle), (object))
CASE(mfv_advance, (mfv_case *handle, const mfv_step *step), (object, step))
CASE(mfv_get_loads, (const mfv_case *handle, mfv_loads *loads), (object, loads))
CASE(mfv_tangent, (mfv_case *handle, int motions, const double *direction, double *tangent), (object, motions, direction, tangent))
CASE(mfv_differentiate, (mfv_case *handle, const char *parameters), (object, parameters))
CASE(mfv_derivative, (const mfv_case *handle, size_t index, mfv_loads *loads, size_t count, double *pressure, double *shear),
     (object, index, loads, count, pressure, shear))
CASE(mfv_save, (const mfv_case *handle, mfv_state **state), (object, state))
CASE(mfv_restore, (mfv_case *handle, const mfv_state *state), (object, state))
CASE(mfv_observe, (mfv_case *handle, mfv_observer observer, void *user), (object, observer, user))
CASE(mfv_field_count, (const mfv_case *handle, size_t *count), (object, count))
CASE(mfv_field_path, (const mfv_case *handle, size_t index, char *buffer, size_t size), (object, index, buffer, size))
CASE(mfv_field_info,
     (const mfv_case *handle, const char *path, size_t *count, int *is_integer, int *along, char *unit, size_t unit_size,
      char *description, size_t description_size),
     (object, path, count, is_integer, along, unit, unit_size, description, description_size))
CASE(mfv_attribute_name, (const mfv_case *handle, size_t index, char *buffer, size_t size), (object, index, buffer, size))
CASE(mfv_attribute, (const mfv_case *handle, const char *name, char *buffer, size_t size, size_t *length),
     (object, name, buffer, size, length))
CASE(mfv_copy_real, (const mfv_case *handle, const char *path, double *values, size_t count), (object, path, values, count))
CASE(mfv_copy_integer, (const mfv_case *handle, const char *path, int32_t *values, size_t count), (object, path, values, count))
CASE(mfv_stress,
     (mfv_case *handle, int body, int step, size_t count, const double *x, const double *y, double *stresses, double *place,
      double *tension),
     (object, body, step, count, x, y, stresses, place, tension))
CASE(mfv_stress_under,
     (mfv_case *handle, int body, size_t nodes, const double *arc, const double *width, const double *pressure, const double *shear,
      const double *contact_edge, const double *stick_edge, double bulk_stress, size_t count, const double *x, const double *y,
      double *stresses, double *place, double *tension),
     (object, body, nodes, arc, width, pressure, shear, contact_edge, stick_edge, bulk_stress, count, x, y, stresses, place, tension))
CASE(mfv_write, (mfv_case *handle, const char *path), (object, path))
GUARD(mfv_message, MFV_KIND_CASE, MFV_READING, (const mfv_case *handle, char *buffer, size_t size), (object, buffer, size))
