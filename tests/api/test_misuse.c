/* Misuse of the C interface. A table has a row for every function of the header; each is called with null for each of its pointers,
 * with handles that are none, and in a callback of its own handle. Then sizes, numbers and names that are wrong, calls
 * in the wrong order, observers that end runs, two threads on one handle, fork, and a host that has changed the arithmetic. After each the
 * handles still work. Usage:
 * test_misuse mfv.h. Prints what failed; exit code 0 when nothing did. */
#define _GNU_SOURCE
#include "check.h"
#include <fenv.h>
#include <limits.h>
#include <math.h>
#include <mfv.h>
#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>
#ifdef __SSE__
#include <xmmintrin.h>
#endif

enum { NODES = 15, ROOM = 2000 };

static const char *const text =
    "&scene coupling='goodman' / &body shape='half_plane', shear_modulus=1.0, poisson_ratio=0.3 /\n"
    "&body shape='disk', radius=0.25, rigid=.true. / &mesh nodes=15, half_width=0.0127 /\n"
    "&friction law='coulomb', mu=0.7 / &step normal_force=1.0e-3, friction=.false. / &step tangential_force=2.8e-4 /\n";

/* Good arguments for every function. What is made by a call goes into `new_...` and is freed again. */
typedef struct {
  mfv_scene *scene;
  mfv_case *handle;
  mfv_state *state;
  mfv_step step;
  mfv_loads loads;
  char buffer[ROOM], other[ROOM];
  double numbers[NODES * MFV_STRESS_COUNT], x[NODES], width[NODES], pressure[NODES], direction[3];
  int32_t whole[NODES];
  size_t count;
  int number;
} bench;

static bench new_bench(void) {
  bench b = {.step = MFV_STEP_INIT, .loads = MFV_LOADS_INIT, .direction = {0, 1, 0}};
  CHECK(mfv_scene_from_text(text, "misuse.nml", &b.scene, NULL, 0) == MFV_COMPLETE);
  CHECK(mfv_create(b.scene, &b.handle, NULL, 0) == MFV_COMPLETE);
  CHECK(mfv_run(b.handle) == MFV_COMPLETE);
  CHECK(mfv_save(b.handle, &b.state) == MFV_COMPLETE);
  CHECK(mfv_copy_real(b.handle, "mesh/x", b.x, NODES) == MFV_COMPLETE && mfv_copy_real(b.handle, "mesh/width", b.width, NODES) == MFV_COMPLETE);
  CHECK(mfv_copy_real(b.handle, "state/pressure", b.pressure, NODES) == MFV_COMPLETE);
  return b;
}

static void free_bench(bench *b) {
  CHECK(mfv_scene_free(&b->scene) == MFV_COMPLETE && mfv_free(&b->handle) == MFV_COMPLETE && mfv_state_free(&b->state) == MFV_COMPLETE);
}

/* The handles still do what they did at first: the loads of the shear to the last digit. */
static void still_works(bench *b, const char *after) {
  mfv_loads loads = MFV_LOADS_INIT;
  int before = failures;
  size_t length = 0;
  CHECK(mfv_restore(b->handle, b->state) == MFV_COMPLETE && mfv_get_loads(b->handle, &loads) == MFV_COMPLETE);
  CHECK(loads.contact_nodes > 5 && fabs(loads.force[MFV_SHIFT] - 2.8e-4) < 1e-15);
  CHECK(mfv_scene_text(b->scene, NULL, 0, &length) == MFV_COMPLETE && length > 100);
  if (failures > before) printf("  after %s\n", after);
}

/* --- a row for every function --- */

/* The pointer of argument `i`, or NULL where that is the one to be null. */
#define OR_NULL(i, pointer) (null == (i) ? NULL : (pointer))
#define ROW(name) static int row_##name(bench *b, int null)

static int always(void *pointer) { return pointer == NULL; }
static int nobody(const mfv_progress *progress, void *user) { return progress == NULL && always(user); }

ROW(mfv_version) { return mfv_version(OR_NULL(0, b->buffer), ROOM); }
ROW(mfv_has_feature) { return mfv_has_feature(OR_NULL(0, "hdf5"), OR_NULL(1, &b->number)); }
ROW(mfv_status_text) { return mfv_status_text(MFV_COMPLETE, OR_NULL(0, b->buffer), ROOM, OR_NULL(1, b->other), ROOM); }
ROW(mfv_key_info) {
  return mfv_key_info(OR_NULL(0, "friction%mu"), OR_NULL(1, &b->number), OR_NULL(2, b->buffer), ROOM, OR_NULL(3, b->other), ROOM);
}
ROW(mfv_observable_info) {
  return mfv_observable_info(0, OR_NULL(0, b->buffer), ROOM, OR_NULL(1, b->other), ROOM, OR_NULL(2, b->other), ROOM);
}
ROW(mfv_reference) { return mfv_reference(OR_NULL(0, "hertz_pressure"), 3, OR_NULL(1, b->x), OR_NULL(2, b->numbers)); }
ROW(mfv_scene_create) {
  mfv_scene *new = NULL;
  (void)b;
  int status = mfv_scene_create(OR_NULL(0, &new));
  mfv_scene_free(&new);
  return status;
}
ROW(mfv_scene_from_text) {
  mfv_scene *new = NULL;
  int status = mfv_scene_from_text(OR_NULL(0, text), OR_NULL(1, "name"), OR_NULL(2, &new), OR_NULL(3, b->buffer), ROOM);
  CHECK(null != 3 || status == MFV_COMPLETE);
  mfv_scene_free(&new);
  return status;
}
ROW(mfv_scene_set_text) { return mfv_scene_set_text(OR_NULL(0, b->scene), OR_NULL(1, "scene%title"), OR_NULL(2, "title")); }
ROW(mfv_scene_set_real) { return mfv_scene_set_real(OR_NULL(0, b->scene), OR_NULL(1, "friction%mu"), 0.7); }
ROW(mfv_scene_set_reals) { return mfv_scene_set_reals(OR_NULL(0, b->scene), OR_NULL(1, "friction%mu"), OR_NULL(2, b->x), 1); }
ROW(mfv_scene_set_integer) { return mfv_scene_set_integer(OR_NULL(0, b->scene), OR_NULL(1, "mesh%nodes"), NODES); }
ROW(mfv_scene_set_logical) { return mfv_scene_set_logical(OR_NULL(0, b->scene), OR_NULL(1, "step(1)%friction"), 0); }
ROW(mfv_scene_make_room) { return mfv_scene_make_room(OR_NULL(0, b->scene), OR_NULL(1, "scene%title")); }
ROW(mfv_scene_remove) { return mfv_scene_remove(OR_NULL(0, b->scene), OR_NULL(1, "scene%title")); }
ROW(mfv_scene_set_data) {
  return mfv_scene_set_data(OR_NULL(0, b->scene), OR_NULL(1, "file"), OR_NULL(2, "x"), NODES, 1, OR_NULL(3, b->x));
}
ROW(mfv_scene_text) { return mfv_scene_text(OR_NULL(0, b->scene), OR_NULL(1, b->buffer), ROOM, OR_NULL(2, &b->count)); }
ROW(mfv_scene_free) {
  mfv_scene *new = b->scene;
  if (null == 0) return mfv_scene_free(NULL);
  if (null == 1) new = NULL;
  return mfv_scene_free(&new);
}
ROW(mfv_create) {
  mfv_case *new = NULL;
  int status = mfv_create(OR_NULL(0, b->scene), OR_NULL(1, &new), OR_NULL(2, b->buffer), ROOM);
  CHECK((status == MFV_COMPLETE) == (new != NULL));
  mfv_free(&new);
  return status;
}
ROW(mfv_create_from_file) {
  mfv_case *new = NULL;
  int status = mfv_create_from_file(OR_NULL(0, "no/such/case.nml"), OR_NULL(1, &new), OR_NULL(2, b->buffer), ROOM);
  CHECK(new == NULL);
  return status;
}
ROW(mfv_create_from_text) {
  mfv_case *new = NULL;
  int status = mfv_create_from_text(OR_NULL(0, text), OR_NULL(1, "name"), OR_NULL(2, &new), OR_NULL(3, b->buffer), ROOM);
  CHECK((status == MFV_COMPLETE) == (new != NULL));
  mfv_free(&new);
  return status;
}
ROW(mfv_copy) {
  mfv_case *new = NULL;
  int status = mfv_copy(OR_NULL(0, b->handle), OR_NULL(1, &new));
  CHECK((status == MFV_COMPLETE) == (new != NULL));
  mfv_free(&new);
  return status;
}
ROW(mfv_free) {
  mfv_case *new = b->handle;
  if (null == 0) return mfv_free(NULL);
  if (null == 1) new = NULL;
  int status = mfv_free(&new);
  CHECK((status == MFV_IN_USE) == (new != NULL));
  return status;
}
ROW(mfv_run) { return mfv_run(OR_NULL(0, b->handle)); }
ROW(mfv_advance) { return mfv_advance(OR_NULL(0, b->handle), OR_NULL(1, &b->step)); }
ROW(mfv_message) { return mfv_message(OR_NULL(0, b->handle), OR_NULL(1, b->buffer), ROOM); }
ROW(mfv_get_loads) { return mfv_get_loads(OR_NULL(0, b->handle), OR_NULL(1, &b->loads)); }
ROW(mfv_tangent) { return mfv_tangent(OR_NULL(0, b->handle), 2, OR_NULL(1, b->direction), OR_NULL(2, b->numbers)); }
ROW(mfv_differentiate) { return mfv_differentiate(OR_NULL(0, b->handle), OR_NULL(1, "shift")); }
ROW(mfv_derivative) {
  mfv_step step = MFV_STEP_INIT;
  step.control[MFV_SHIFT] = MFV_DISPLACEMENT;
  (void)mfv_differentiate(b->handle, "shift");
  (void)mfv_advance(b->handle, &step);
  return mfv_derivative(OR_NULL(0, b->handle), 0, OR_NULL(1, &b->loads), NODES, OR_NULL(2, b->numbers), OR_NULL(3, &b->numbers[NODES]));
}
ROW(mfv_save) {
  mfv_state *new = NULL;
  int status = mfv_save(OR_NULL(0, b->handle), OR_NULL(1, &new));
  CHECK((status == MFV_COMPLETE) == (new != NULL));
  mfv_state_free(&new);
  return status;
}
ROW(mfv_restore) { return mfv_restore(OR_NULL(0, b->handle), OR_NULL(1, b->state)); }
ROW(mfv_state_free) {
  mfv_state *new = b->state;
  if (null == 0) return mfv_state_free(NULL);
  if (null == 1) new = NULL;
  return mfv_state_free(&new);
}
ROW(mfv_stop_when_set) {
  mfv_progress progress = {.size = sizeof progress};
  b->number = 0;
  return mfv_stop_when_set(OR_NULL(0, &progress), OR_NULL(1, &b->number));
}
ROW(mfv_observe) { return mfv_observe(OR_NULL(0, b->handle), OR_NULL(1, nobody), OR_NULL(2, b)); }
ROW(mfv_field_count) { return mfv_field_count(OR_NULL(0, b->handle), OR_NULL(1, &b->count)); }
ROW(mfv_field_path) { return mfv_field_path(OR_NULL(0, b->handle), 0, OR_NULL(1, b->buffer), ROOM); }
ROW(mfv_field_info) {
  return mfv_field_info(OR_NULL(0, b->handle), OR_NULL(1, "state/shear"), OR_NULL(2, &b->count), OR_NULL(3, &b->number),
                        OR_NULL(4, &b->number), OR_NULL(5, b->buffer), ROOM, OR_NULL(6, b->other), ROOM);
}
ROW(mfv_attribute_name) { return mfv_attribute_name(OR_NULL(0, b->handle), 0, OR_NULL(1, b->buffer), ROOM); }
ROW(mfv_attribute) {
  return mfv_attribute(OR_NULL(0, b->handle), OR_NULL(1, "outcome"), OR_NULL(2, b->buffer), ROOM, OR_NULL(3, &b->count));
}
ROW(mfv_copy_real) { return mfv_copy_real(OR_NULL(0, b->handle), OR_NULL(1, "state/shear"), OR_NULL(2, b->numbers), NODES); }
ROW(mfv_copy_integer) { return mfv_copy_integer(OR_NULL(0, b->handle), OR_NULL(1, "state/status"), OR_NULL(2, b->whole), NODES); }
ROW(mfv_stress) {
  return mfv_stress(OR_NULL(0, b->handle), MFV_LOWER, 0, NODES, OR_NULL(1, b->x), OR_NULL(2, b->x), OR_NULL(3, b->numbers),
                    OR_NULL(4, b->direction), OR_NULL(5, b->direction));
}
ROW(mfv_stress_under) {
  return mfv_stress_under(OR_NULL(0, b->handle), MFV_LOWER, NODES, OR_NULL(1, b->x), OR_NULL(2, b->width), OR_NULL(3, b->pressure),
                          OR_NULL(4, b->pressure), OR_NULL(5, b->x), OR_NULL(6, b->x), 0.0, NODES, OR_NULL(7, b->x), OR_NULL(8, b->x),
                          OR_NULL(9, b->numbers), OR_NULL(10, b->direction), OR_NULL(11, b->direction));
}
ROW(mfv_write) { return mfv_write(OR_NULL(0, b->handle), OR_NULL(1, "no/such/folder/x.h5")); }

/* What null gives: a bad handle, a bad argument, nothing that is wrong, or what the call gives in any case. */
enum { H = MFV_BAD_HANDLE, A = MFV_BAD_ARGUMENT, OK = MFV_COMPLETE, I = MFV_INPUT_ERROR, F = MFV_FILE_ERROR };
typedef enum { NO_HANDLE, SCENE, CASE, STATE } sort;
enum { MOST_POINTERS = 12 };

/* `of`: what the first handle is of. `frees`: the handle comes by its address. `good`: status of the call with good arguments. */
typedef struct {
  const char *name;
  int (*call)(bench *, int);
  sort of;
  int frees, good, pointers;
  int null[MOST_POINTERS];
} row;

static const row rows[] = {
    {"mfv_version", row_mfv_version, NO_HANDLE, 0, OK, 1, {A}},
    {"mfv_has_feature", row_mfv_has_feature, NO_HANDLE, 0, OK, 2, {A, A}},
    {"mfv_status_text", row_mfv_status_text, NO_HANDLE, 0, OK, 2, {A, A}},
    {"mfv_key_info", row_mfv_key_info, NO_HANDLE, 0, OK, 4, {A, OK, OK, OK}},
    {"mfv_observable_info", row_mfv_observable_info, NO_HANDLE, 0, OK, 3, {OK, OK, OK}},
    {"mfv_reference", row_mfv_reference, NO_HANDLE, 0, OK, 3, {A, A, A}},
    {"mfv_scene_create", row_mfv_scene_create, NO_HANDLE, 0, OK, 1, {A}},
    {"mfv_scene_from_text", row_mfv_scene_from_text, NO_HANDLE, 0, OK, 4, {A, OK, A, OK}},
    {"mfv_scene_set_text", row_mfv_scene_set_text, SCENE, 0, OK, 3, {H, A, A}},
    {"mfv_scene_set_real", row_mfv_scene_set_real, SCENE, 0, OK, 2, {H, A}},
    {"mfv_scene_set_reals", row_mfv_scene_set_reals, SCENE, 0, OK, 3, {H, A, A}},
    {"mfv_scene_set_integer", row_mfv_scene_set_integer, SCENE, 0, OK, 2, {H, A}},
    {"mfv_scene_set_logical", row_mfv_scene_set_logical, SCENE, 0, OK, 2, {H, A}},
    {"mfv_scene_make_room", row_mfv_scene_make_room, SCENE, 0, OK, 2, {H, A}},
    {"mfv_scene_remove", row_mfv_scene_remove, SCENE, 0, OK, 2, {H, A}},
    {"mfv_scene_set_data", row_mfv_scene_set_data, SCENE, 0, OK, 4, {H, A, A, A}},
    {"mfv_scene_text", row_mfv_scene_text, SCENE, 0, OK, 3, {H, OK, OK}},
    {"mfv_scene_free", row_mfv_scene_free, SCENE, 1, OK, 2, {OK, OK}},
    {"mfv_create", row_mfv_create, SCENE, 0, OK, 3, {H, A, OK}},
    {"mfv_create_from_file", row_mfv_create_from_file, NO_HANDLE, 0, I, 3, {A, A, I}},
    {"mfv_create_from_text", row_mfv_create_from_text, NO_HANDLE, 0, OK, 4, {A, OK, A, OK}},
    {"mfv_copy", row_mfv_copy, CASE, 0, OK, 2, {H, A}},
    {"mfv_free", row_mfv_free, CASE, 1, OK, 2, {OK, OK}},
    {"mfv_run", row_mfv_run, CASE, 0, OK, 1, {H}},
    {"mfv_advance", row_mfv_advance, CASE, 0, OK, 2, {H, A}},
    {"mfv_message", row_mfv_message, CASE, 0, OK, 2, {H, A}},
    {"mfv_get_loads", row_mfv_get_loads, CASE, 0, OK, 2, {H, A}},
    {"mfv_tangent", row_mfv_tangent, CASE, 0, OK, 3, {H, OK, A}},
    {"mfv_differentiate", row_mfv_differentiate, CASE, 0, OK, 2, {H, A}},
    {"mfv_derivative", row_mfv_derivative, CASE, 0, OK, 4, {H, OK, OK, OK}},
    {"mfv_save", row_mfv_save, CASE, 0, OK, 2, {H, A}},
    {"mfv_restore", row_mfv_restore, CASE, 0, OK, 2, {H, H}},
    {"mfv_state_free", row_mfv_state_free, STATE, 1, OK, 2, {OK, OK}},
    {"mfv_stop_when_set", row_mfv_stop_when_set, NO_HANDLE, 0, OK, 2, {OK, OK}},
    {"mfv_observe", row_mfv_observe, CASE, 0, OK, 3, {H, OK, OK}},
    {"mfv_field_count", row_mfv_field_count, CASE, 0, OK, 2, {H, A}},
    {"mfv_field_path", row_mfv_field_path, CASE, 0, OK, 2, {H, A}},
    {"mfv_field_info", row_mfv_field_info, CASE, 0, OK, 7, {H, A, OK, OK, OK, OK, OK}},
    {"mfv_attribute_name", row_mfv_attribute_name, CASE, 0, OK, 2, {H, A}},
    {"mfv_attribute", row_mfv_attribute, CASE, 0, OK, 4, {H, A, OK, OK}},
    {"mfv_copy_real", row_mfv_copy_real, CASE, 0, OK, 3, {H, A, A}},
    {"mfv_copy_integer", row_mfv_copy_integer, CASE, 0, OK, 3, {H, A, A}},
    {"mfv_stress", row_mfv_stress, CASE, 0, OK, 6, {H, A, A, OK, OK, OK}},
    {"mfv_stress_under", row_mfv_stress_under, CASE, 0, OK, 12, {H, A, A, A, A, OK, OK, A, A, OK, OK, OK}},
    {"mfv_write", row_mfv_write, CASE, 0, F, 2, {H, A}},
};
enum { ROWS = sizeof rows / sizeof rows[0] };

/* The closed forms and their numbers of arguments. */
static const struct {
  const char *name;
  size_t count;
} forms[] = {
    {"hertz_half_width", 4}, {"hertz_pressure", 3}, {"flat_punch_pressure", 3},
    {"spence_stick_ratio", 2}, {"spence_cylinder_shear", 5}, {"spence_flat_punch_shear", 5},
    {"mindlin_stick_ratio", 3}, {"mindlin_shear", 5}, {"mindlin_dissipation", 5},
    {"carter_creepage", 5}, {"carter_shear", 5},
    {"power_half_width", 5}, {"power_approach", 4}, {"power_pressure", 4}, {"power_stick_ratio", 4}, {"power_shear", 6},
    {"rounded_punch_half_width", 5}, {"rounded_punch_approach", 4}, {"rounded_punch_pressure", 4},
    {"rounded_punch_stick_ratio", 5}, {"rounded_punch_shear", 6},
    {"persson_force", 4}, {"yield_contact_arc", 3}, {"surface_compliance", 7}, {"oblique_half_width", 5}, {"oblique_stick_ratio", 4},
    {"wave_half_width", 5}, {"wave_pressure", 6}, {"wave_stick_ratio", 7},
};
enum { FORMS = sizeof forms / sizeof forms[0], MOST_NUMBERS = 6 };

static int has_row(const char *name) {
  for (int i = 0; i < ROWS; ++i)
    if (strcmp(rows[i].name, name) == 0) return 1;
  return 0;
}

/* Every name of the header that is followed by a bracket, outside of comments, is a function, and has a row. */
static void every_function_has_a_row(const char *header) {
  static char code[100000];
  int functions = 0;
  FILE *file = fopen(header, "r");
  CHECK(file != NULL);
  if (file == NULL) return;
  size_t length = fread(code, 1, sizeof code - 1, file);
  fclose(file);
  CHECK(length > 10000 && length < sizeof code - 1);
  for (char *comment; (comment = strstr(code, "/*")) != NULL;) {
    char *end = strstr(comment, "*/");
    memset(comment, ' ', (size_t)(end + 2 - comment));
  }
  for (const char *at = code; (at = strstr(at, " mfv_")) != NULL;) {
    char name[80] = "";
    ++at;
    if (sscanf(at, "%79[a-z0-9_]", name) != 1 || at[strlen(name)] != '(') continue;
    ++functions;
    CHECK(has_row(name));
    if (!has_row(name)) printf("  %s\n", name);
  }
  CHECK(functions == ROWS);
}

static void null_for_each_pointer(void) {
  for (int i = 0; i < ROWS; ++i) {
    bench b = new_bench();
    const row *this = &rows[i];
    for (int null = 0; null < this->pointers; ++null) {
      int status = this->call(&b, null);
      CHECK(status == this->null[null]);
      if (status != this->null[null]) printf("  %s with null for pointer %d: %d\n", this->name, null, status);
      if (this->of == CASE && status == MFV_BAD_ARGUMENT && strcmp(this->name, "mfv_copy") != 0 && strcmp(this->name, "mfv_message") != 0) {
        CHECK(mfv_message(b.handle, b.other, ROOM) == MFV_COMPLETE && strlen(b.other) > 0 && strstr(b.other, "reached") == NULL);
        if (strlen(b.other) == 0 || strstr(b.other, "reached") != NULL) printf("  %s with null for pointer %d\n", this->name, null);
      }
      still_works(&b, this->name);
    }
    int status = this->frees ? this->good : this->call(&b, -1);
    CHECK(status == this->good);
    if (status != this->good) printf("  %s with good arguments: %d\n", this->name, status);
    still_works(&b, this->name);
    free_bench(&b);
  }
}

/* Every function with handles that are none of its sort: freed, of other sorts, made up, addresses. */
static void bad_handles(void) {
  static double memory[100];
  bench b = new_bench(), freed = new_bench(), fresh;
  bench with = freed;
  free_bench(&freed);
  fresh = new_bench(); /* takes the places of those that were freed */
  void *const bad[] = {with.scene, with.handle, with.state, memory, &memory[7], (char *)memory + 1, (void *)1, (void *)3, (void *)UINTPTR_MAX,
                       (void *)(UINTPTR_MAX >> 1), (void *)b.scene, (void *)b.handle, (void *)b.state, malloc(8)};
  for (size_t k = 0; k < sizeof bad / sizeof bad[0]; ++k)
    for (int i = 0; i < ROWS; ++i) {
      bench wrong = b;
      const row *this = &rows[i];
      if (this->of == NO_HANDLE || (this->of == SCENE && bad[k] == b.scene) || (this->of == CASE && bad[k] == b.handle) ||
          (this->of == STATE && bad[k] == b.state))
        continue;
      if (this->of == SCENE) wrong.scene = bad[k];
      if (this->of == CASE) wrong.handle = bad[k];
      if (this->of == STATE) wrong.state = bad[k];
      int status = this->call(&wrong, -1);
      CHECK(status == MFV_BAD_HANDLE);
      if (status != MFV_BAD_HANDLE) printf("  %s with bad handle %zu: %d\n", this->name, k, status);
    }
  /* The second handle of a call. */
  for (size_t k = 0; k < sizeof bad / sizeof bad[0]; ++k) {
    mfv_state *state = bad[k];
    if (bad[k] == b.state) continue;
    CHECK(mfv_restore(b.handle, state) == MFV_BAD_HANDLE && mfv_save(b.handle, &state) == MFV_BAD_HANDLE && state == bad[k]);
    CHECK(mfv_message(b.handle, b.buffer, ROOM) == MFV_COMPLETE && strstr(b.buffer, "state") != NULL);
  }
  free(bad[sizeof bad / sizeof bad[0] - 1]);
  still_works(&b, "bad handles");
  still_works(&fresh, "bad handles");
  /* Freed twice, by a copy of the handle. */
  mfv_case *copy = fresh.handle, *again = fresh.handle;
  CHECK(mfv_free(&copy) == MFV_COMPLETE && copy == NULL);
  CHECK(mfv_free(&again) == MFV_BAD_HANDLE && again == NULL && mfv_run(fresh.handle) == MFV_BAD_HANDLE);
  fresh.handle = NULL;
  free_bench(&fresh);
  free_bench(&b);
}

/* Handles that are made and freed for ever are never the same again. */
static void handles_do_not_come_again(void) {
  enum { TIMES = 3000 };
  static mfv_scene *seen[TIMES];
  int same = 0, live = 0;
  for (int i = 0; i < TIMES; ++i) {
    mfv_scene *scene = NULL;
    CHECK(mfv_scene_create(&scene) == MFV_COMPLETE);
    seen[i] = scene;
    if (i % 3 != 0) mfv_scene_free(&scene);
  }
  for (int i = 1; i < TIMES; ++i) same += seen[i] == seen[i - 1];
  for (int i = 0; i < TIMES; ++i) live += mfv_scene_remove(seen[i], "scene%title") == MFV_COMPLETE;
  CHECK(same == 0 && live == TIMES / 3);
  for (int i = 0; i < TIMES; i += 3) CHECK(mfv_scene_free(&seen[i]) == MFV_COMPLETE);
}

/* --- wrong sizes, numbers and names --- */

/* A call on the case was refused, and the message says why. */
static void refused(bench *b, int status, const char *word) {
  CHECK(status == MFV_BAD_ARGUMENT);
  CHECK(mfv_message(b->handle, b->buffer, ROOM) == MFV_COMPLETE);
  CHECK(strstr(b->buffer, word) != NULL);
  if (status != MFV_BAD_ARGUMENT || strstr(b->buffer, word) == NULL) printf("  status %d, '%s', wanted '%s'\n", status, b->buffer, word);
}

static void wrong_sizes(void) {
  static const size_t sizes[] = {0, 1, NODES - 1, NODES + 1, INT_MAX, (size_t)INT_MAX + 1, SIZE_MAX / 8, SIZE_MAX};
  bench b = new_bench();
  for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; ++i) {
    mfv_step step = b.step;
    mfv_loads loads = b.loads;
    refused(&b, mfv_copy_real(b.handle, "state/shear", b.numbers, sizes[i]), "15 values");
    refused(&b, mfv_copy_integer(b.handle, "state/status", b.whole, sizes[i]), "15 values");
    step.size = loads.size = sizes[i];
    refused(&b, mfv_advance(b.handle, &step), "sizeof(mfv_step)");
    refused(&b, mfv_derivative(b.handle, 0, NULL, NODES, b.numbers, NULL), "no derivatives");
    refused(&b, mfv_get_loads(b.handle, &loads), "sizeof(mfv_loads)");
  }
  for (size_t i = 4; i < sizeof sizes / sizeof sizes[0]; ++i) {
    size_t size = sizes[i];
    refused(&b, mfv_field_path(b.handle, size, b.buffer, ROOM), "fields");
    refused(&b, mfv_attribute_name(b.handle, size, b.buffer, ROOM), "attributes");
    if (size == INT_MAX) continue;
    refused(&b, mfv_stress(b.handle, MFV_LOWER, 0, size, b.x, b.x, b.numbers, NULL, NULL), "count");
    refused(&b, mfv_stress_under(b.handle, MFV_LOWER, size, b.x, b.width, b.pressure, b.pressure, NULL, NULL, 0.0, 0, NULL, NULL, NULL, b.numbers, NULL),
            "nodes");
    refused(&b, mfv_stress_under(b.handle, MFV_LOWER, NODES, b.x, b.width, b.pressure, b.pressure, NULL, NULL, 0.0, size, b.x, b.x, b.numbers, NULL, NULL),
            "count");
    CHECK(mfv_scene_set_reals(b.scene, "friction%mu", b.x, size) == MFV_BAD_ARGUMENT);
    CHECK(mfv_scene_set_data(b.scene, "file", "x", size, 1, b.x) == MFV_BAD_ARGUMENT);
    CHECK(mfv_scene_set_data(b.scene, "file", "x", 1, size, b.x) == MFV_BAD_ARGUMENT);
  }
  CHECK(mfv_scene_set_reals(b.scene, "friction%mu", b.x, 0) == MFV_BAD_ARGUMENT);
  CHECK(mfv_stress(b.handle, MFV_LOWER, 0, 0, NULL, NULL, NULL, NULL, NULL) == MFV_COMPLETE);
  refused(&b, mfv_stress_under(b.handle, MFV_LOWER, 0, b.x, b.width, b.pressure, b.pressure, NULL, NULL, 0.0, 0, NULL, NULL, NULL, b.numbers, NULL),
            "nodes");
  /* Intervals lie from left to right, side by side. */
  double arc[NODES], double_width[NODES];
  for (int i = 0; i < NODES; ++i) arc[i] = b.x[NODES - 1 - i];
  for (int i = 0; i < NODES; ++i) double_width[i] = 2.0 * b.width[i];
  refused(&b, mfv_stress_under(b.handle, MFV_LOWER, NODES, arc, b.width, b.pressure, b.pressure, NULL, NULL, 0.0, 0, NULL, NULL, NULL, b.numbers, NULL),
          "left to right");
  refused(&b, mfv_stress_under(b.handle, MFV_LOWER, NODES, b.x, double_width, b.pressure, b.pressure, NULL, NULL, 0.0, 0, NULL, NULL, NULL, b.numbers, NULL),
          "overlap");
  /* Texts are cut to the room that there is. */
  char tiny[2] = "z";
  CHECK(mfv_message(b.handle, tiny, 0) == MFV_BAD_ARGUMENT && tiny[0] == 'z');
  CHECK(mfv_message(b.handle, tiny, 1) == MFV_COMPLETE && tiny[0] == '\0' && tiny[1] == '\0');
  CHECK(mfv_version(tiny, 2) == MFV_COMPLETE && strlen(tiny) == 1);
  refused(&b, mfv_field_path(b.handle, 0, tiny, 0), "buffer");
  refused(&b, mfv_attribute_name(b.handle, 0, tiny, 0), "buffer");
  refused(&b, mfv_attribute(b.handle, "outcome", tiny, 0, NULL), "buffer");
  still_works(&b, "wrong sizes");
  free_bench(&b);
}

/* Derivatives: parameters that are none or passed, numbers and sizes that are wrong, and after them those that are right. */
static void wrong_parameters(void) {
  bench b = new_bench();
  mfv_step step = MFV_STEP_INIT;
  mfv_loads loads = b.loads;
  refused(&b, mfv_differentiate(b.handle, "friction%mu"), "before the first step");
  refused(&b, mfv_differentiate(b.handle, "step(2)%shift"), "already begun");
  refused(&b, mfv_differentiate(b.handle, "shift step(3)%cycles"), "not the target of a motion");
  refused(&b, mfv_differentiate(b.handle, "mesh%half_width"), "&layer or &friction");
  refused(&b, mfv_differentiate(b.handle, "slide"), "unknown key of &step");
  refused(&b, mfv_derivative(b.handle, 0, &loads, 0, NULL, NULL), "no derivatives");
  CHECK(mfv_differentiate(b.handle, "shift step(3)%normal_force") == MFV_COMPLETE);
  step.control[MFV_SHIFT] = MFV_DISPLACEMENT;
  step.target[MFV_SHIFT] = 1e-5;
  step.relative = 1;
  CHECK(mfv_advance(b.handle, &step) == MFV_COMPLETE);
  refused(&b, mfv_derivative(b.handle, 0, &loads, 0, NULL, NULL), "not a target");
  CHECK(mfv_restore(b.handle, b.state) == MFV_COMPLETE && mfv_differentiate(b.handle, "shift") == MFV_COMPLETE);
  CHECK(mfv_advance(b.handle, &step) == MFV_COMPLETE);
  refused(&b, mfv_derivative(b.handle, 1, &loads, 0, NULL, NULL), "there are 1");
  refused(&b, mfv_derivative(b.handle, SIZE_MAX, &loads, 0, NULL, NULL), "there are 1");
  refused(&b, mfv_derivative(b.handle, 0, NULL, NODES + 1, b.numbers, NULL), "number of nodes");
  loads.size = 1;
  refused(&b, mfv_derivative(b.handle, 0, &loads, 0, NULL, NULL), "sizeof(mfv_loads)");
  loads.size = sizeof loads;
  CHECK(mfv_derivative(b.handle, 0, &loads, NODES, b.numbers, &b.numbers[NODES]) == MFV_COMPLETE);
  CHECK(fabs(loads.motion[MFV_SHIFT] - 1) < 1e-12 && loads.force[MFV_SHIFT] > 0 && loads.linear_solves > 0);
  CHECK(mfv_differentiate(b.handle, "") == MFV_COMPLETE);
  refused(&b, mfv_derivative(b.handle, 0, &loads, 0, NULL, NULL), "no derivatives");
  still_works(&b, "wrong parameters");
  free_bench(&b);
}

static void wrong_numbers(void) {
  static const double odd[] = {NAN, INFINITY, -INFINITY, 1e308, -1e308, 5e-324};
  static const int whole[] = {INT_MIN, -1, 3, 7, INT_MAX};
  bench b = new_bench();
  for (size_t i = 0; i < sizeof odd / sizeof odd[0]; ++i) {
    mfv_step step = MFV_STEP_INIT;
    double points[2] = {odd[i], -0.01}, down[2] = {-0.01, odd[i]}, stresses[2 * MFV_STRESS_COUNT], direction[3] = {0, odd[i], 0};
    step.control[MFV_SHIFT] = MFV_DISPLACEMENT;
    step.target[MFV_SHIFT] = odd[i];
    int status = mfv_advance(b.handle, &step);
    CHECK(status != MFV_COMPLETE || fabs(odd[i]) < 1e-300);
    CHECK((status == MFV_BAD_ARGUMENT) == !isfinite(odd[i]));
    CHECK(mfv_restore(b.handle, b.state) == MFV_COMPLETE);
    step = (mfv_step)MFV_STEP_INIT;
    step.cycles = 2;
    step.control[MFV_SHIFT] = MFV_FORCE;
    step.target[MFV_SHIFT] = 1e-4;
    step.steady_tolerance = odd[i];
    status = mfv_advance(b.handle, &step);
    CHECK((status == MFV_BAD_ARGUMENT) == !(isfinite(odd[i]) && odd[i] >= 0));
    CHECK(mfv_restore(b.handle, b.state) == MFV_COMPLETE);
    step = (mfv_step)MFV_STEP_INIT;
    step.control[MFV_LOWER_BULK_STRESS] = MFV_DISPLACEMENT;
    step.target[MFV_LOWER_BULK_STRESS] = odd[i];
    status = mfv_advance(b.handle, &step);
    CHECK((status == MFV_BAD_ARGUMENT) == !isfinite(odd[i]));
    CHECK(mfv_restore(b.handle, b.state) == MFV_COMPLETE);
    status = mfv_stress_under(b.handle, MFV_LOWER, NODES, b.x, b.width, b.pressure, b.pressure, NULL, NULL, odd[i], 1, points, down,
                              stresses, NULL, NULL);
    CHECK((status == MFV_BAD_ARGUMENT) == !isfinite(odd[i]));
    CHECK(mfv_stress(b.handle, MFV_LOWER, 0, 2, points, down, stresses, NULL, NULL) == MFV_COMPLETE);
    CHECK(isfinite(odd[i]) || (isnan(stresses[0]) && isnan(stresses[MFV_STRESS_COUNT + MFV_VON_MISES])));
    status = mfv_tangent(b.handle, 2, direction, b.numbers);
    CHECK((status == MFV_BAD_ARGUMENT) || isfinite(odd[i]));
    CHECK(mfv_scene_set_real(b.scene, "scene%nothing", odd[i]) == MFV_BAD_ARGUMENT);
    status = mfv_scene_set_reals(b.scene, "friction%mu", &odd[i], 1);
    CHECK((status == MFV_BAD_ARGUMENT) == !isfinite(odd[i]));
    status = mfv_scene_set_real(b.scene, "friction%mu", odd[i]);
    CHECK((status == MFV_BAD_ARGUMENT) == !isfinite(odd[i]));
    mfv_case *none = NULL;
    mfv_scene *scene = NULL;
    CHECK(mfv_scene_from_text(text, NULL, &scene, NULL, 0) == MFV_COMPLETE);
    mfv_scene_set_real(scene, "friction%mu", odd[i]);
    status = mfv_create(scene, &none, b.buffer, ROOM);
    CHECK(mfv_scene_free(&scene) == MFV_COMPLETE);
    CHECK(status == MFV_INPUT_ERROR && strstr(b.buffer, "mu") != NULL); /* sizes are from 1e-100 to 1e100 */
    mfv_free(&none);
    for (int k = 0; k < 4; ++k) {
      double list[4][NODES], edges[NODES];
      memcpy(list[0], b.x, sizeof b.x);
      memcpy(list[1], b.width, sizeof b.width);
      memcpy(list[2], b.pressure, sizeof b.pressure);
      memcpy(list[3], b.pressure, sizeof b.pressure);
      list[k][3] = odd[i];
      status = mfv_stress_under(b.handle, MFV_LOWER, NODES, list[0], list[1], list[2], list[3], NULL, NULL, 0.0, 1, points, down, stresses,
                                NULL, NULL);
      CHECK(status == MFV_COMPLETE || status == MFV_BAD_ARGUMENT);
      CHECK(isfinite(odd[i]) || status == MFV_BAD_ARGUMENT);
      /* Edges are the caller's too: what is no zone is none. */
      memcpy(edges, b.x, sizeof edges);
      edges[k] = odd[i];
      status = mfv_stress_under(b.handle, MFV_LOWER, NODES, b.x, b.width, b.pressure, b.pressure, edges, edges, 0.0, 1, points, down, stresses,
                                NULL, b.numbers);
      CHECK(status == MFV_COMPLETE);
    }
  }
  for (size_t i = 0; i < sizeof whole / sizeof whole[0]; ++i) {
    mfv_step step = MFV_STEP_INIT;
    step.control[MFV_APPROACH] = whole[i];
    refused(&b, mfv_advance(b.handle, &step), "control");
    step = (mfv_step)MFV_STEP_INIT;
    step.control[MFV_ROTATION] = whole[i];
    refused(&b, mfv_advance(b.handle, &step), "control");
    step = (mfv_step)MFV_STEP_INIT;
    step.control[MFV_LOWER_BULK_STRESS] = whole[i];
    refused(&b, mfv_advance(b.handle, &step), "control");
    step = (mfv_step)MFV_STEP_INIT;
    step.cycles = whole[i];
    int status = mfv_advance(b.handle, &step);
    CHECK(whole[i] == 3 || whole[i] == 7 || status == MFV_BAD_ARGUMENT);
    CHECK(mfv_restore(b.handle, b.state) == MFV_COMPLETE);
    if (whole[i] != 3) refused(&b, mfv_tangent(b.handle, whole[i], NULL, b.numbers), "motions");
    refused(&b, mfv_stress(b.handle, whole[i], 0, 1, b.x, b.x, b.numbers, NULL, NULL), "MFV_LOWER");
    refused(&b, mfv_stress(b.handle, MFV_LOWER, whole[i], 1, b.x, b.x, b.numbers, NULL, NULL), "step");
    refused(&b, mfv_stress(b.handle, whole[i], 0, 0, NULL, NULL, NULL, b.numbers, NULL), "MFV_LOWER");
    refused(&b, mfv_stress(b.handle, MFV_LOWER, whole[i], 0, NULL, NULL, NULL, b.numbers, NULL), "step");
    CHECK((mfv_status_text(whole[i], b.buffer, ROOM, b.other, ROOM) == MFV_COMPLETE) == (whole[i] == 3 || whole[i] == 7));
    CHECK(mfv_scene_set_integer(b.scene, "friction%mu", whole[i]) == MFV_COMPLETE);
  }
  mfv_step step = MFV_STEP_INIT;
  step.control[MFV_LOWER_BULK_STRESS] = MFV_FORCE;
  refused(&b, mfv_advance(b.handle, &step), "MFV_DISPLACEMENT");
  step = (mfv_step)MFV_STEP_INIT;
  step.control[MFV_UPPER_BULK_STRESS] = MFV_DISPLACEMENT; /* the upper body is a rigid disk */
  refused(&b, mfv_advance(b.handle, &step), "half-plane");
  still_works(&b, "wrong numbers");
  free_bench(&b);
}

/* Whether there are ends of lines or bytes beyond ASCII in it (none of those above is UTF-8). */
static int is_no_text(const char *name) {
  for (; *name != '\0'; ++name)
    if (*name == '\n' || (unsigned char)*name > 127) return 1;
  return 0;
}

static void wrong_names(void) {
  enum { LONG = 20000 };
  char *long_name = malloc(LONG + 1);
  memset(long_name, 'a', LONG);
  long_name[LONG] = '\0';
  memcpy(long_name, "state/", 6);
  const char *const names[] = {"",      " ",    "/",        "%",       "//",      "state/", "/shear", "state/shear ", "STATE/SHEAR", "%s%n%d", "body(0)%radius",
                               "\xff\xfe", "\xc3", "state/\xf0\x9f", "a\nb%c\td", "body(99999999999999999999)%radius", "body(-1)%radius", "body(9)%radius",
                               "state/../shear", long_name};
  bench b = new_bench();
  for (size_t i = 0; i < sizeof names / sizeof names[0]; ++i) {
    const char *name = names[i];
    char *path = malloc(LONG + 100);
    mfv_case *none = NULL;
    mfv_scene *nothing = NULL;
    sprintf(path, "no/such/folder/%s", name);
    refused(&b, mfv_copy_real(b.handle, name, b.numbers, NODES), "");
    refused(&b, mfv_copy_integer(b.handle, name, b.whole, NODES), "");
    refused(&b, mfv_field_info(b.handle, name, &b.count, NULL, NULL, NULL, 0, NULL, 0), "there is no field");
    refused(&b, mfv_attribute(b.handle, name, b.other, ROOM, NULL), "there is no attribute");
    CHECK(mfv_has_feature(name, &b.number) == MFV_BAD_ARGUMENT && b.number == 0);
    CHECK(mfv_scene_set_real(b.scene, name, 1) == MFV_BAD_ARGUMENT && mfv_scene_set_integer(b.scene, name, 1) == MFV_BAD_ARGUMENT);
    CHECK(mfv_scene_set_reals(b.scene, name, b.x, 1) == MFV_BAD_ARGUMENT && mfv_scene_set_logical(b.scene, name, 1) == MFV_BAD_ARGUMENT);
    CHECK(mfv_scene_set_text(b.scene, name, "x") == MFV_BAD_ARGUMENT && mfv_scene_remove(b.scene, name) == MFV_BAD_ARGUMENT);
    CHECK(mfv_scene_set_data(b.scene, "file", name, 1, 1, b.x) == MFV_BAD_ARGUMENT);
    CHECK(mfv_create_from_file(path, &none, b.other, ROOM) == MFV_INPUT_ERROR && none == NULL && strlen(b.other) > 0);
    CHECK(mfv_create_from_text(name, name, &none, b.other, ROOM) == MFV_INPUT_ERROR && none == NULL && strlen(b.other) > 0);
    if (strspn(name, " ") < strlen(name))
      CHECK(mfv_scene_from_text(name, name, &nothing, b.other, ROOM) == MFV_INPUT_ERROR && nothing == NULL && strlen(b.other) > 0);
    CHECK(mfv_write(b.handle, path) == MFV_FILE_ERROR);
    free(path);
  }
  /* What values are, is judged when a case is made, whatever is in them. */
  for (size_t i = 0; i < sizeof names / sizeof names[0]; ++i) {
    mfv_scene *scene = NULL;
    mfv_case *none = NULL;
    CHECK(mfv_scene_from_text(text, NULL, &scene, NULL, 0) == MFV_COMPLETE);
    int status = mfv_scene_set_text(scene, "scene%coupling", names[i]);
    CHECK(status == MFV_COMPLETE || (status == MFV_BAD_ARGUMENT && is_no_text(names[i])));
    CHECK(mfv_create(scene, &none, b.other, ROOM) == MFV_INPUT_ERROR && none == NULL && strstr(b.other, "coupling") != NULL);
    mfv_scene_free(&scene);
  }
  still_works(&b, "wrong names");
  free_bench(&b);
  free(long_name);
}

/* Closed forms with each argument, and each two of them, odd: NaN or a number, never a crash, also where exceptions trap. */
static void closed_forms(void) {
  static const double odd[] = {NAN, INFINITY, -INFINITY, -1, 0, 1e300, 1e-300, 0.4, 1};
  enum { ODD = sizeof odd / sizeof odd[0] };
  double x[MOST_NUMBERS], value = 0;
  for (int i = 0; i < FORMS; ++i) {
    for (size_t one = 0; one < forms[i].count; ++one)
      for (size_t other = 0; other < forms[i].count; ++other)
        for (int k = 0; k < ODD * ODD; ++k) {
          for (int l = 0; l < MOST_NUMBERS; ++l) x[l] = 0.3;
          x[one] = odd[k / ODD];
          x[other] = odd[k % ODD];
          CHECK(mfv_reference(forms[i].name, forms[i].count, x, &value) == MFV_COMPLETE);
          CHECK(isnan(value) || (isfinite(x[one]) && isfinite(x[other])));
          if (!isnan(value) && !(isfinite(x[one]) && isfinite(x[other]))) printf("  %s %zu %zu\n", forms[i].name, one, other);
        }
    CHECK(mfv_reference(forms[i].name, forms[i].count - 1, x, &value) == MFV_BAD_ARGUMENT && isnan(value));
  }
  CHECK(mfv_reference("hertz", 3, x, &value) == MFV_BAD_ARGUMENT && mfv_reference("", 3, x, &value) == MFV_BAD_ARGUMENT);
  CHECK(mfv_reference("hertz_pressure", 0, x, &value) == MFV_BAD_ARGUMENT);
  CHECK(mfv_reference("hertz_pressure", SIZE_MAX, x, &value) == MFV_BAD_ARGUMENT);
}

/* --- the wrong order --- */

static void before_and_after(void) {
  mfv_scene *scene = NULL;
  mfv_case *handle = NULL, *other = NULL;
  mfv_state *state = NULL;
  mfv_loads loads = MFV_LOADS_INIT;
  char buffer[ROOM];
  double tangent[4], place[3], numbers[NODES];
  size_t fields = 0;
  CHECK(mfv_scene_from_text(text, NULL, &scene, NULL, 0) == MFV_COMPLETE && mfv_create(scene, &handle, NULL, 0) == MFV_COMPLETE);
  /* Asked before anything was solved: the unloaded state. */
  CHECK(mfv_get_loads(handle, &loads) == MFV_COMPLETE && loads.contact_nodes == 0 && loads.force[MFV_APPROACH] == 0);
  CHECK(mfv_field_count(handle, &fields) == MFV_COMPLETE && fields > 20);
  CHECK(mfv_copy_real(handle, "state/pressure", numbers, NODES) == MFV_COMPLETE && numbers[7] == 0);
  int status = mfv_tangent(handle, 2, NULL, tangent);
  CHECK(status == MFV_COMPLETE || status == MFV_BAD_ARGUMENT);
  CHECK(mfv_stress(handle, MFV_LOWER, 0, 0, NULL, NULL, NULL, place, NULL) == MFV_COMPLETE && place[0] == 0);
  CHECK(mfv_stress(handle, MFV_LOWER, 1, 0, NULL, NULL, NULL, place, NULL) == MFV_BAD_ARGUMENT);
  CHECK(mfv_message(handle, buffer, ROOM) == MFV_COMPLETE);
  CHECK(mfv_write(handle, NULL) == MFV_BAD_ARGUMENT);
  CHECK(mfv_save(handle, &state) == MFV_COMPLETE);
  /* The scene changes and goes; the case stays as it was made. */
  CHECK(mfv_scene_set_real(scene, "friction%mu", 0.1) == MFV_COMPLETE && mfv_scene_free(&scene) == MFV_COMPLETE);
  CHECK(mfv_observe(handle, NULL, NULL) == MFV_COMPLETE && mfv_run(handle) == MFV_COMPLETE);
  CHECK(mfv_get_loads(handle, &loads) == MFV_COMPLETE && fabs(loads.force[MFV_SHIFT] - 2.8e-4) < 1e-15);
  /* Run again: there is nothing left to do. */
  mfv_loads again = MFV_LOADS_INIT;
  CHECK(mfv_run(handle) == MFV_COMPLETE && mfv_get_loads(handle, &again) == MFV_COMPLETE && memcmp(&loads, &again, sizeof again) == 0);
  /* A state of another scene, of a case that is gone, and before the beginning. */
  CHECK(mfv_create_from_text("&body shape='half_plane', shear_modulus=1.0, poisson_ratio=0.3 / &body shape='disk', radius=1., rigid=T /\n"
                             "&mesh half_width=0.1 /",
                             NULL, &other, NULL, 0) == MFV_COMPLETE);
  CHECK(mfv_restore(other, state) == MFV_BAD_ARGUMENT && mfv_message(other, buffer, ROOM) == MFV_COMPLETE);
  CHECK(strstr(buffer, "another scene") != NULL);
  CHECK(mfv_restore(handle, state) == MFV_COMPLETE && mfv_run(handle) == MFV_COMPLETE);
  CHECK(mfv_get_loads(handle, &again) == MFV_COMPLETE && memcmp(&loads, &again, sizeof again) == 0);
  CHECK(mfv_free(&other) == MFV_COMPLETE && mfv_free(&handle) == MFV_COMPLETE && mfv_state_free(&state) == MFV_COMPLETE);
}

/* --- in a callback --- */

typedef struct {
  bench *own, *other;
  int calls, stop_at, depth, wrong;
} visit;

/* Every function on the handle that calls back; then the same on another one, which works. */
static int call_everything(const mfv_progress *progress, void *user) {
  visit *self = user;
  CHECK(progress->size == sizeof *progress);
  if (self->calls++ > 0) return 0;
  for (int i = 0; i < ROWS; ++i) {
    if (rows[i].of != CASE) continue;
    int status = rows[i].call(self->own, -1);
    self->wrong += status != MFV_IN_USE;
    if (status != MFV_IN_USE) printf("  %s in a callback of its handle: %d\n", rows[i].name, status);
  }
  mfv_case *handle = self->own->handle;
  CHECK(mfv_free(&handle) == MFV_IN_USE && handle == self->own->handle);
  for (int i = 0; i < ROWS; ++i)
    if (rows[i].of == CASE && !rows[i].frees) {
      int status = rows[i].call(self->other, -1);
      CHECK(status == rows[i].good);
      if (status != rows[i].good) printf("  %s on another handle in a callback: %d\n", rows[i].name, status);
    }
  return 0;
}

static int dive(const mfv_progress *progress, void *user) {
  visit *self = user;
  mfv_case *deeper = NULL;
  visit next = {.depth = self->depth - 1};
  if (self->calls++ > 0 || self->depth == 0) return progress == NULL;
  CHECK(mfv_create_from_text(text, NULL, &deeper, NULL, 0) == MFV_COMPLETE && mfv_observe(deeper, dive, &next) == MFV_COMPLETE);
  CHECK(mfv_run(deeper) == MFV_COMPLETE && next.calls > 1);
  CHECK(mfv_free(&deeper) == MFV_COMPLETE);
  return 0;
}

static void inside_callbacks(void) {
  bench b = new_bench(), other = new_bench();
  mfv_step step = MFV_STEP_INIT;
  step.control[MFV_SHIFT] = MFV_FORCE;
  step.target[MFV_SHIFT] = -2.8e-4;
  visit seen = {.own = &b, .other = &other};
  CHECK(mfv_observe(b.handle, call_everything, &seen) == MFV_COMPLETE);
  CHECK(mfv_advance(b.handle, &step) == MFV_COMPLETE && seen.calls > 1 && seen.wrong == 0);
  CHECK(mfv_observe(b.handle, NULL, NULL) == MFV_COMPLETE);
  still_works(&b, "calls in a callback");
  still_works(&other, "calls in a callback");
  /* Runs within runs. */
  visit deep = {.depth = 3};
  CHECK(mfv_observe(b.handle, dive, &deep) == MFV_COMPLETE && mfv_advance(b.handle, &step) == MFV_COMPLETE && deep.calls > 1);
  CHECK(mfv_observe(b.handle, NULL, NULL) == MFV_COMPLETE);
  still_works(&b, "runs within runs");
  free_bench(&b);
  free_bench(&other);
}

static int stop(const mfv_progress *progress, void *user) {
  visit *self = user;
  return progress != NULL && ++self->calls == self->stop_at;
}

/* Ended at the first, at any and at the last call, a step goes on to the same end. */
static void ended_at_every_call(void) {
  bench b = new_bench();
  mfv_step step = MFV_STEP_INIT;
  mfv_loads end = MFV_LOADS_INIT, after = MFV_LOADS_INIT;
  visit all = {.stop_at = -1};
  step.control[MFV_SHIFT] = MFV_FORCE;
  step.target[MFV_SHIFT] = -3.5e-4;
  CHECK(mfv_observe(b.handle, stop, &all) == MFV_COMPLETE && mfv_advance(b.handle, &step) == MFV_COMPLETE && all.calls > 2);
  CHECK(mfv_get_loads(b.handle, &end) == MFV_COMPLETE);
  for (int at = 1; at <= all.calls; ++at) {
    visit part = {.stop_at = at};
    CHECK(mfv_restore(b.handle, b.state) == MFV_COMPLETE && mfv_observe(b.handle, stop, &part) == MFV_COMPLETE);
    CHECK(mfv_advance(b.handle, &step) == MFV_INTERRUPTED && part.calls == at);
    CHECK(mfv_message(b.handle, b.buffer, ROOM) == MFV_COMPLETE && strstr(b.buffer, "stopped on request") != NULL);
    CHECK(mfv_run(b.handle) == MFV_INTERRUPTED && part.calls == at);
    CHECK(mfv_advance(b.handle, &step) == MFV_COMPLETE && mfv_get_loads(b.handle, &after) == MFV_COMPLETE);
    CHECK(fabs(after.motion[MFV_SHIFT] / end.motion[MFV_SHIFT] - 1) < 1e-11 && after.stick_nodes == end.stick_nodes);
  }
  CHECK(mfv_observe(b.handle, NULL, NULL) == MFV_COMPLETE);
  still_works(&b, "ending runs");
  free_bench(&b);
}

/* --- two threads on one handle, and fork --- */

static atomic_int done, passes;

/* What another thread gets: the answer, or that the handle is in use. */
static void *disturb(void *argument) {
  bench own = *(bench *)argument;
  long odd = 0;
  for (; !done; ++passes)
    for (int i = 0; i < ROWS; ++i) {
      if (rows[i].of != CASE || rows[i].frees || rows[i].call == row_mfv_observe) continue;
      int status = rows[i].call(&own, -1);
      sched_yield(); /* valgrind runs one thread at a time, and would change it in the middle of calls alone */
      if (status == rows[i].good || status == MFV_IN_USE) continue;
      if (odd++ == 0) printf("  %s beside another thread: %d\n", rows[i].name, status);
    }
  return (void *)odd;
}

static void *free_it(void *argument) {
  mfv_case *handle = argument;
  return (void *)(intptr_t)mfv_free(&handle);
}

static void two_threads(void) {
  bench b = new_bench();
  pthread_t thread;
  void *odd = NULL;
  int in_use = 0, complete = 0, calls = 0;
  done = 0;
  CHECK(pthread_create(&thread, NULL, disturb, &b) == 0);
  for (; (complete < 10 || passes == 0) && calls < 1000000; ++calls) {
    int status = mfv_advance(b.handle, &b.step);
    in_use += status == MFV_IN_USE;
    complete += status == MFV_COMPLETE;
    if (status == MFV_IN_USE) sched_yield();
  }
  done = 1;
  pthread_join(thread, &odd);
  CHECK(odd == NULL && in_use + complete == calls && complete >= 10 && passes > 0);
  still_works(&b, "two threads on one handle");
  /* Both free the same case: one does. */
  for (int i = 0; i < 50; ++i) {
    mfv_case *copy = NULL, *mine;
    void *theirs = NULL;
    CHECK(mfv_copy(b.handle, &copy) == MFV_COMPLETE);
    mine = copy;
    CHECK(pthread_create(&thread, NULL, free_it, copy) == 0);
    int own = mfv_free(&mine);
    pthread_join(thread, &theirs);
    int both[2] = {own, (int)(intptr_t)theirs};
    CHECK((both[0] == MFV_COMPLETE) + (both[1] == MFV_COMPLETE) == 1);
  }
  free_bench(&b);
}

/* A child goes on with the handles of its parent, each with its own. */
static void after_fork(void) {
  bench b = new_bench();
  int status = -1;
  mfv_step step = MFV_STEP_INIT;
  mfv_loads end = MFV_LOADS_INIT;
  step.control[MFV_SHIFT] = MFV_FORCE;
  step.target[MFV_SHIFT] = -2.8e-4;
  fflush(stdout);
  pid_t child = fork();
  CHECK(child >= 0);
  if (child == 0) _exit(mfv_advance(b.handle, &step) == MFV_COMPLETE && mfv_free(&b.handle) == MFV_COMPLETE ? 0 : 1);
  CHECK(waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0);
  still_works(&b, "fork");
  CHECK(mfv_advance(b.handle, &step) == MFV_COMPLETE && mfv_get_loads(b.handle, &end) == MFV_COMPLETE);
  free_bench(&b);
}

/* --- a host that has changed the arithmetic --- */

/* Shear tractions of the whole case, and its certificate. */
static double solve(double *shear) {
  mfv_case *handle = NULL;
  double certificate = NAN;
  CHECK(mfv_create_from_text(text, NULL, &handle, NULL, 0) == MFV_COMPLETE && mfv_run(handle) == MFV_COMPLETE);
  CHECK(mfv_copy_real(handle, "state/shear", shear, NODES) == MFV_COMPLETE);
  CHECK(mfv_copy_real(handle, "certificate/largest", &certificate, 1) == MFV_COMPLETE);
  CHECK(mfv_free(&handle) == MFV_COMPLETE);
  return certificate;
}

/* Traps and numbers flushed to zero change no digit; other rounding does, and the certificate stays small. The library leaves all as
 * it was. The rounding comes last: tables of sines that are made under it stay. */
static void changed_arithmetic(void) {
  double shear[NODES], other[NODES];
  CHECK(solve(shear) < 1e-12);
#ifdef __GLIBC__
  const int before_traps = fegetexcept();
  CHECK(feenableexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW) != -1);
  const int traps = fegetexcept(); /* none in valgrind */
  CHECK(solve(other) < 1e-12 && memcmp(shear, other, sizeof shear) == 0);
  CHECK(fegetexcept() == traps && fedisableexcept(FE_ALL_EXCEPT) != -1 && feenableexcept(before_traps) != -1);
#endif
#ifdef __SSE__
  const unsigned flush = 0x8040, before = _mm_getcsr();
  _mm_setcsr(before | flush);
  const unsigned flushed = _mm_getcsr() & flush; /* 0 in valgrind */
  CHECK(solve(other) < 1e-12 && memcmp(shear, other, sizeof shear) == 0 && (_mm_getcsr() & flush) == flushed);
  _mm_setcsr(before);
#endif
#if defined(FE_UPWARD) && defined(FE_DOWNWARD) && defined(FE_TOWARDZERO)
  static const int roundings[] = {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO};
  for (size_t i = 0; i < sizeof roundings / sizeof roundings[0]; ++i) {
    CHECK(fesetround(roundings[i]) == 0);
    CHECK(solve(other) < 1e-11 && fegetround() == roundings[i]);
    CHECK(fesetround(FE_TONEAREST) == 0);
  }
#endif
}

int main(int argc, char **argv) {
  if (argc != 2) {
    fprintf(stderr, "usage: test_misuse mfv.h\n");
    return 2;
  }
  setvbuf(stdout, NULL, _IOLBF, BUFSIZ); /* a crash must not take what was told before */
  every_function_has_a_row(argv[1]);
  null_for_each_pointer();
  bad_handles();
  handles_do_not_come_again();
  wrong_sizes();
  wrong_parameters();
  wrong_numbers();
  wrong_names();
  closed_forms();
  before_and_after();
  inside_callbacks();
  ended_at_every_call();
  two_threads();
  after_fork();
  changed_arithmetic();
  printf(failures == 0 ? "misuse: all checks passed\n" : "misuse: %d checks failed\n", failures);
  return failures != 0;
}
