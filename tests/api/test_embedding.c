/* The C interface as somebody else's simulator uses it: scenes by calls, increments, trial steps, tangent, observers. Prints
 * what failed; exit code 0 when nothing did. */
#include "check.h"
#include <math.h>
#include <mfv.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { NODES = 41 };

static const char *const text =
    "&scene coupling='goodman' / &body shape='half_plane', shear_modulus=1.0, poisson_ratio=0.3 /\n"
    "&body shape='disk', radius=0.25, rigid=.true. / &mesh nodes=41, half_width=0.0127 /\n"
    "&friction law='coulomb', mu=0.7 /\n";

/* The scene of the text, by calls. */
static mfv_scene *cylinder(void) {
  mfv_scene *scene = NULL;
  CHECK(mfv_scene_create(&scene) == MFV_COMPLETE && scene != NULL);
  CHECK(mfv_scene_set_text(scene, "scene%coupling", "goodman") == MFV_COMPLETE);
  CHECK(mfv_scene_set_text(scene, "body(1)%shape", "half_plane") == MFV_COMPLETE);
  CHECK(mfv_scene_set_real(scene, "body(1)%shear_modulus", 1.0) == MFV_COMPLETE);
  CHECK(mfv_scene_set_real(scene, "body(1)%poisson_ratio", 0.3) == MFV_COMPLETE);
  CHECK(mfv_scene_set_text(scene, "body(2)%shape", "disk") == MFV_COMPLETE);
  CHECK(mfv_scene_set_real(scene, "body(2)%radius", 0.25) == MFV_COMPLETE);
  CHECK(mfv_scene_set_logical(scene, "body(2)%rigid", 1) == MFV_COMPLETE);
  CHECK(mfv_scene_set_integer(scene, "mesh%nodes", NODES) == MFV_COMPLETE);
  CHECK(mfv_scene_set_real(scene, "mesh%half_width", 0.0127) == MFV_COMPLETE);
  CHECK(mfv_scene_set_text(scene, "friction%law", "coulomb") == MFV_COMPLETE);
  CHECK(mfv_scene_set_real(scene, "friction%mu", 0.7) == MFV_COMPLETE);
  return scene;
}

static mfv_case *created(const mfv_scene *scene) {
  mfv_case *handle = NULL;
  char message[400] = "";
  CHECK(mfv_create(scene, &handle, message, sizeof message) == MFV_COMPLETE);
  if (handle == NULL) printf("%s\n", message);
  return handle;
}

/* One step: controls and targets. */
static int lead(mfv_case *handle, int normal, double normal_target, int tangential, double tangential_target, int friction,
                int relative) {
  mfv_step step = MFV_STEP_INIT;
  step.control[MFV_APPROACH] = normal;
  step.target[MFV_APPROACH] = normal_target;
  step.control[MFV_SHIFT] = tangential;
  step.target[MFV_SHIFT] = tangential_target;
  step.friction = friction;
  step.relative = relative;
  return mfv_advance(handle, &step);
}

static void press(mfv_case *handle) { CHECK(lead(handle, MFV_FORCE, 1e-3, MFV_KEEP, 0, 0, 0) == MFV_COMPLETE); }

static mfv_loads loads_of(const mfv_case *handle) {
  mfv_loads loads = MFV_LOADS_INIT;
  CHECK(mfv_get_loads(handle, &loads) == MFV_COMPLETE);
  return loads;
}

static int same_loads(const mfv_loads *one, const mfv_loads *other) {
  return memcmp(one, other, sizeof *one) == 0;
}

static void calls_are_the_text(void) {
  mfv_scene *scene = cylinder(), *from_text = NULL;
  mfv_case *one = created(scene), *other = NULL, *third = NULL;
  char written[2000] = "";
  size_t length = 0;
  CHECK(mfv_create_from_text(text, NULL, &other, NULL, 0) == MFV_COMPLETE);
  CHECK(mfv_scene_from_text(text, "x", &from_text, NULL, 0) == MFV_COMPLETE);
  third = created(from_text);
  press(one);
  press(other);
  press(third);
  mfv_loads a = loads_of(one), b = loads_of(other), c = loads_of(third);
  CHECK(same_loads(&a, &b) && same_loads(&a, &c) && a.contact_nodes > 20);
  CHECK(mfv_scene_text(scene, NULL, 0, &length) == MFV_COMPLETE && length > 100 && length < sizeof written);
  CHECK(mfv_scene_text(scene, written, sizeof written, NULL) == MFV_COMPLETE && strlen(written) == length);
  CHECK(strstr(written, "shape='half_plane'") != NULL);
  /* The scene may change and go; the case stays. */
  CHECK(mfv_scene_remove(scene, "mesh%half_width") == MFV_COMPLETE);
  CHECK(mfv_scene_text(scene, written, sizeof written, NULL) == MFV_COMPLETE && strstr(written, "half_width") == NULL);
  CHECK(mfv_scene_set_real(scene, "friction%mu", -1) == MFV_COMPLETE);
  CHECK(mfv_scene_free(&scene) == MFV_COMPLETE && scene == NULL);
  CHECK(lead(one, MFV_KEEP, 0, MFV_FORCE, 1e-4, 1, 0) == MFV_COMPLETE);
  mfv_free(&one);
  mfv_free(&other);
  mfv_free(&third);
  mfv_scene_free(&from_text);
}

static void data_in_memory(void) {
  mfv_scene *scene = cylinder();
  double x[NODES], height[NODES];
  for (int i = 0; i < NODES; ++i) {
    x[i] = 0.001 * (i - NODES / 2);
    height[i] = 2 * x[i] * x[i];
  }
  CHECK(mfv_scene_free(&scene) == MFV_COMPLETE);
  CHECK(mfv_scene_from_text("&body shape='half_plane', shear_modulus=1.0, poisson_ratio=0.3 /\n"
                            "&body shape='profile', file='punch', rigid=.true. / &mesh nodes=41, half_width=0.0127 /\n",
                            NULL, &scene, NULL, 0) == MFV_COMPLETE);
  CHECK(mfv_scene_set_data(scene, "punch", "x", NODES, 1, x) == MFV_COMPLETE);
  CHECK(mfv_scene_set_data(scene, "punch", "height", NODES, 1, height) == MFV_COMPLETE);
  mfv_case *handle = created(scene);
  press(handle);
  CHECK(loads_of(handle).contact_nodes > 20);
  mfv_free(&handle);
  CHECK(mfv_scene_set_data(scene, "punch", "height", NODES - 1, 1, height) == MFV_COMPLETE);
  char message[400] = "";
  CHECK(mfv_create(scene, &handle, message, sizeof message) == MFV_INPUT_ERROR && handle == NULL);
  CHECK(strstr(message, "height") != NULL);
  mfv_scene_free(&scene);

  /* A matrix goes in by rows: one that is not symmetric is refused with its place. */
  const double positions[2] = {0, 1}, matrix[4] = {3, 2, 1, 3};
  CHECK(mfv_scene_from_text("&body shape='matrix', file='m' / &body shape='disk', radius=9., rigid=.true. /", NULL, &scene, NULL, 0) ==
        MFV_COMPLETE);
  CHECK(mfv_scene_set_data(scene, "m", "x", 2, 1, positions) == MFV_COMPLETE);
  CHECK(mfv_scene_set_data(scene, "m", "compliance", 2, 2, matrix) == MFV_COMPLETE);
  CHECK(mfv_create(scene, &handle, message, sizeof message) == MFV_INPUT_ERROR && strstr(message, "symmetric") != NULL);
  mfv_scene_free(&scene);
}

/* Ten increments lead where one step leads. */
static void increments(void) {
  mfv_scene *scene = cylinder();
  mfv_case *whole = created(scene), *parts = created(scene);
  press(whole);
  press(parts);
  CHECK(lead(whole, MFV_KEEP, 0, MFV_DISPLACEMENT, 1e-4, 1, 0) == MFV_COMPLETE);
  for (int i = 0; i < 10; ++i) CHECK(lead(parts, MFV_KEEP, 0, MFV_DISPLACEMENT, 1e-5, 1, 1) == MFV_COMPLETE);
  mfv_loads a = loads_of(whole), b = loads_of(parts);
  CHECK(fabs(b.motion[MFV_SHIFT] / 1e-4 - 1) < 1e-14 && fabs(a.force[MFV_SHIFT] / b.force[MFV_SHIFT] - 1) < 1e-10);
  CHECK(lead(parts, MFV_FORCE, -2e-3, MFV_KEEP, 0, 1, 1) == MFV_BAD_ARGUMENT); /* P would be negative */
  CHECK(lead(parts, MFV_FORCE, -2e-4, MFV_KEEP, 0, 1, 1) == MFV_COMPLETE);
  CHECK(fabs(loads_of(parts).force[MFV_APPROACH] / 8e-4 - 1) < 1e-12);
  mfv_free(&whole);
  mfv_free(&parts);
  mfv_scene_free(&scene);
}

/* Newton's iteration towards a tangential force, by shifts that are tried and taken back: the tangent makes it quick. */
static void newton_by_trial_steps(void) {
  mfv_scene *scene = cylinder();
  const double wanted = 6.5e-4;
  CHECK(mfv_scene_set_text(scene, "output%history", "none") == MFV_COMPLETE);
  CHECK(mfv_scene_set_text(scene, "output%states", "none") == MFV_COMPLETE);
  mfv_case *handle = created(scene), *direct = created(scene);
  mfv_state *start = NULL;
  press(handle);
  press(direct);
  CHECK(mfv_save(handle, &start) == MFV_COMPLETE && start != NULL);
  const double forth[2] = {0, 1};
  double tangent[4], shift = 0, residual = wanted;
  CHECK(lead(handle, MFV_KEEP, 0, MFV_FORCE, 1e-9, 1, 0) == MFV_COMPLETE); /* friction comes on */
  CHECK(mfv_tangent(handle, 2, forth, tangent) == MFV_COMPLETE);
  int iterations = 0;
  for (; iterations < 20 && fabs(residual) > 1e-13 * wanted; ++iterations) {
    const double stiffness = tangent[3] - tangent[2] * tangent[1] / tangent[0]; /* at constant normal force */
    shift += residual / stiffness;
    CHECK(mfv_restore(handle, start) == MFV_COMPLETE);
    CHECK(lead(handle, MFV_KEEP, 0, MFV_DISPLACEMENT, shift, 1, 0) == MFV_COMPLETE);
    CHECK(mfv_tangent(handle, 2, NULL, tangent) == MFV_COMPLETE);
    residual = wanted - loads_of(handle).force[MFV_SHIFT];
  }
  CHECK(iterations > 2 && iterations < 9);
  CHECK(lead(direct, MFV_KEEP, 0, MFV_FORCE, wanted, 1, 0) == MFV_COMPLETE);
  CHECK(fabs(loads_of(direct).motion[MFV_SHIFT] / shift - 1) < 1e-10);
  CHECK(tangent[1] == 0.0 && tangent[0] > 0); /* Goodman: shear does not press */

  /* The storage of a state is used again; a state outlives its case and serves a copy of it. */
  mfv_state *same = start;
  CHECK(mfv_save(handle, &start) == MFV_COMPLETE && start == same);
  mfv_case *copy = NULL;
  CHECK(mfv_copy(handle, &copy) == MFV_COMPLETE);
  mfv_loads before = loads_of(handle);
  CHECK(lead(copy, MFV_KEEP, 0, MFV_FORCE, -wanted, 1, 0) == MFV_COMPLETE);
  mfv_loads unmoved = loads_of(handle);
  CHECK(same_loads(&before, &unmoved));
  mfv_free(&handle);
  CHECK(mfv_restore(copy, start) == MFV_COMPLETE);
  mfv_loads again = loads_of(copy);
  CHECK(same_loads(&before, &again));
  /* Beyond what friction carries, and back. */
  CHECK(lead(copy, MFV_KEEP, 0, MFV_FORCE, 1.0, 1, 0) == MFV_GROSS_SLIDING);
  CHECK(lead(copy, MFV_KEEP, 0, MFV_FORCE, 0.0, 1, 0) == MFV_GROSS_SLIDING);
  CHECK(mfv_restore(copy, start) == MFV_COMPLETE);
  CHECK(lead(copy, MFV_KEEP, 0, MFV_FORCE, 0.0, 1, 0) == MFV_COMPLETE);
  mfv_free(&copy);
  mfv_free(&direct);
  mfv_state_free(&start);
  CHECK(start == NULL);
  mfv_scene_free(&scene);
}

/* What an observer saw, and when it wants to stop. */
typedef struct {
  int calls, stop_at, in_order;
  double force;
  size_t size;
} witness;

static int watch(const mfv_progress *progress, void *user) {
  witness *self = user;
  self->size = progress->size;
  self->in_order = self->in_order && progress->force[MFV_SHIFT] >= self->force && progress->fraction >= 0 &&
                   progress->fraction <= 1 && progress->segment == 1 && progress->segments == 1;
  self->force = progress->force[MFV_SHIFT];
  return ++self->calls == self->stop_at;
}

/* The last part of the load history that there was word of. */
typedef struct {
  int last, all;
} parts;

static int count_parts(const mfv_progress *progress, void *user) {
  parts *self = user;
  self->last = progress->segment;
  self->all = progress->segments;
  return 0;
}

static void observers(void) {
  mfv_scene *scene = cylinder();
  mfv_case *handle = created(scene);
  mfv_state *start = NULL;
  witness seen = {0, 0, 1, 0, 0};
  press(handle);
  CHECK(mfv_save(handle, &start) == MFV_COMPLETE);
  CHECK(mfv_observe(handle, watch, &seen) == MFV_COMPLETE);
  CHECK(lead(handle, MFV_KEEP, 0, MFV_FORCE, 3.5e-4, 1, 0) == MFV_COMPLETE);
  CHECK(seen.calls >= loads_of(handle).events && seen.calls > 4 && seen.in_order && seen.force == loads_of(handle).force[MFV_SHIFT]);
  CHECK(seen.size == sizeof(mfv_progress));
  CHECK(mfv_restore(handle, start) == MFV_COMPLETE);
  witness stopping = {0, 3, 1, 0, 0};
  CHECK(mfv_observe(handle, watch, &stopping) == MFV_COMPLETE);
  CHECK(lead(handle, MFV_KEEP, 0, MFV_FORCE, 3.5e-4, 1, 0) == MFV_INTERRUPTED);
  CHECK(stopping.calls == 3 && loads_of(handle).force[MFV_SHIFT] > 0 && loads_of(handle).force[MFV_SHIFT] < 3.5e-4);
  /* An interrupted step leaves a state to go on from. */
  CHECK(mfv_observe(handle, NULL, NULL) == MFV_COMPLETE);
  CHECK(lead(handle, MFV_KEEP, 0, MFV_FORCE, 3.5e-4, 1, 0) == MFV_COMPLETE);
  CHECK(fabs(loads_of(handle).force[MFV_SHIFT] / 3.5e-4 - 1) < 1e-12);
  /* Parts of cycles are counted. */
  parts counted = {0, 0};
  mfv_step cycles = MFV_STEP_INIT;
  cycles.control[MFV_SHIFT] = MFV_FORCE;
  cycles.target[MFV_SHIFT] = -3.5e-4;
  cycles.cycles = 3;
  CHECK(mfv_observe(handle, count_parts, &counted) == MFV_COMPLETE);
  CHECK(mfv_advance(handle, &cycles) == MFV_COMPLETE && counted.last == 6 && counted.all == 6);
  CHECK(mfv_restore(handle, start) == MFV_COMPLETE);
  CHECK(mfv_observe(handle, NULL, NULL) == MFV_COMPLETE);
  CHECK(lead(handle, MFV_KEEP, 0, MFV_FORCE, 3.5e-4, 1, 0) == MFV_COMPLETE);
  CHECK(stopping.calls == 3);
  mfv_free(&handle);
  mfv_state_free(&start);
  mfv_scene_free(&scene);
}

/* A message is that of the last call that failed, or of the outcome: calls that go well leave it. */
static void success_leaves_the_message(void) {
  mfv_scene *scene = cylinder();
  mfv_case *handle = created(scene);
  mfv_state *state = NULL;
  mfv_loads loads = MFV_LOADS_INIT;
  char reached[400] = "", message[400] = "", buffer[100];
  double tangent[4], shear[NODES], x[1] = {0.0}, y[1] = {-0.1}, stresses[MFV_STRESS_COUNT], place[3];
  size_t count = 0;
  press(handle);
  CHECK(mfv_message(handle, reached, sizeof reached) == MFV_COMPLETE && strstr(reached, "was reached") != NULL);
  CHECK(mfv_get_loads(handle, &loads) == MFV_COMPLETE && mfv_tangent(handle, 2, NULL, tangent) == MFV_COMPLETE);
  CHECK(mfv_save(handle, &state) == MFV_COMPLETE && mfv_restore(handle, state) == MFV_COMPLETE);
  CHECK(mfv_field_count(handle, &count) == MFV_COMPLETE && mfv_field_path(handle, 0, buffer, sizeof buffer) == MFV_COMPLETE);
  CHECK(mfv_attribute_name(handle, 0, buffer, sizeof buffer) == MFV_COMPLETE);
  CHECK(mfv_attribute(handle, "outcome", buffer, sizeof buffer, NULL) == MFV_COMPLETE && strcmp(buffer, "complete") == 0);
  CHECK(mfv_copy_real(handle, "state/shear", shear, NODES) == MFV_COMPLETE);
  CHECK(mfv_stress(handle, MFV_LOWER, 0, 1, x, y, stresses, NULL, NULL) == MFV_COMPLETE);
  CHECK(mfv_stress(handle, MFV_LOWER, 0, 0, NULL, NULL, NULL, place, NULL) == MFV_COMPLETE);
  CHECK(mfv_message(handle, message, sizeof message) == MFV_COMPLETE && strcmp(message, reached) == 0);
  CHECK(mfv_attribute(handle, "colour", buffer, sizeof buffer, NULL) == MFV_BAD_ARGUMENT);
  CHECK(mfv_message(handle, message, sizeof message) == MFV_COMPLETE && strstr(message, "colour") != NULL);
  mfv_state_free(&state);
  mfv_free(&handle);
  mfv_scene_free(&scene);
}

static void misuse_is_told(void) {
  mfv_scene *scene = NULL;
  mfv_case *handle = NULL, *other = NULL;
  mfv_state *state = NULL, *nothing = NULL;
  char message[400] = "";
  int there = -1;
  double tangent[9] = {0};
  mfv_loads loads = MFV_LOADS_INIT;
  CHECK(mfv_scene_create(NULL) == MFV_BAD_ARGUMENT);
  CHECK(mfv_scene_set_real(NULL, "mesh%nodes", 1) == MFV_BAD_HANDLE);
  CHECK(mfv_scene_free(NULL) == MFV_COMPLETE && mfv_scene_free(&scene) == MFV_COMPLETE);
  CHECK(mfv_scene_from_text("&body shape=", "here", &scene, message, sizeof message) == MFV_INPUT_ERROR && scene == NULL);
  CHECK(strstr(message, "here:1") != NULL);
  scene = cylinder();
  CHECK(mfv_scene_set_text(scene, NULL, "x") == MFV_BAD_ARGUMENT && mfv_scene_set_text(scene, "scene%title", NULL) == MFV_BAD_ARGUMENT);
  CHECK(mfv_scene_remove(scene, NULL) == MFV_BAD_ARGUMENT && mfv_scene_remove(NULL, "friction%mu") == MFV_BAD_HANDLE);
  CHECK(mfv_scene_set_reals(scene, "friction%mu", NULL, 3) == MFV_BAD_ARGUMENT);
  CHECK(mfv_scene_set_data(scene, "f", "x", 0, 1, tangent) == MFV_BAD_ARGUMENT);
  CHECK(mfv_create(scene, NULL, NULL, 0) == MFV_BAD_ARGUMENT && mfv_create(NULL, &handle, NULL, 0) == MFV_BAD_HANDLE);
  /* Nobody looked at these: mfv_create tells, until they are mended. */
  CHECK(mfv_create(scene, &handle, message, sizeof message) == MFV_INPUT_ERROR && strstr(message, "scene%title: an argument is null") != NULL);
  CHECK(mfv_scene_set_text(scene, "scene%title", "a title") == MFV_COMPLETE);
  CHECK(mfv_create(scene, &handle, message, sizeof message) == MFV_INPUT_ERROR && strstr(message, "friction%mu") != NULL);
  CHECK(mfv_scene_set_real(scene, "friction%mu", 0.7) == MFV_COMPLETE);
  CHECK(mfv_create(scene, &handle, message, sizeof message) == MFV_INPUT_ERROR && strstr(message, "f: an argument") != NULL);
  CHECK(mfv_scene_free(&scene) == MFV_COMPLETE);
  scene = cylinder();
  CHECK(mfv_scene_set_data(scene, "f", "x", 1, 1, tangent) == MFV_COMPLETE);
  CHECK(mfv_create(scene, &handle, message, sizeof message) == MFV_INPUT_ERROR && strstr(message, "no key refers to the data 'f'") != NULL);
  CHECK(mfv_scene_set_data(scene, "f", "gaps", 1, 1, tangent) == MFV_BAD_ARGUMENT);
  CHECK(mfv_scene_free(&scene) == MFV_COMPLETE);
  CHECK(mfv_create(NULL, &handle, message, sizeof message) == MFV_BAD_HANDLE && strstr(message, "null") != NULL);
  scene = cylinder();
  handle = created(scene);
  /* A key that does not exist: told at once, and with its name by mfv_create. */
  CHECK(mfv_scene_set_real(scene, "mesh%noodles", 3) == MFV_BAD_ARGUMENT);
  CHECK(mfv_create(scene, &other, message, sizeof message) == MFV_INPUT_ERROR && other == NULL);
  CHECK(strstr(message, "mesh%noodles") != NULL && strstr(message, "nodes") != NULL);
  mfv_scene_free(&scene);
  /* A handle of one sort is none of another. */
  CHECK(mfv_run((mfv_case *)NULL) == MFV_BAD_HANDLE);
  CHECK(mfv_save(handle, NULL) == MFV_BAD_ARGUMENT && mfv_save(NULL, &state) == MFV_BAD_HANDLE && state == NULL);
  CHECK(mfv_restore(handle, NULL) == MFV_BAD_HANDLE);
  CHECK(mfv_save(handle, &state) == MFV_COMPLETE);
  CHECK(mfv_restore(handle, (mfv_state *)handle) == MFV_BAD_HANDLE);
  CHECK(mfv_message((mfv_case *)state, message, sizeof message) == MFV_BAD_HANDLE);
  CHECK(mfv_state_free(&nothing) == MFV_COMPLETE && mfv_state_free(NULL) == MFV_COMPLETE);
  /* A state of another scene. */
  scene = cylinder();
  mfv_scene_set_integer(scene, "mesh%nodes", NODES + 2);
  other = created(scene);
  CHECK(mfv_restore(other, state) == MFV_BAD_ARGUMENT);
  CHECK(mfv_message(other, message, sizeof message) == MFV_COMPLETE && strstr(message, "another scene") != NULL);
  CHECK(mfv_tangent(handle, MFV_MOTIONS + 1, NULL, tangent) == MFV_BAD_ARGUMENT && mfv_tangent(handle, 2, NULL, NULL) == MFV_BAD_ARGUMENT);
  CHECK(mfv_tangent(handle, 2000000, NULL, tangent) == MFV_BAD_ARGUMENT && mfv_tangent(handle, -1, NULL, tangent) == MFV_BAD_ARGUMENT);
  const double none[2] = {0, 0}, infinite[2] = {0, INFINITY};
  CHECK(mfv_tangent(handle, 2, none, tangent) == MFV_BAD_ARGUMENT && mfv_tangent(handle, 2, infinite, tangent) == MFV_BAD_ARGUMENT);
  loads.size = 3;
  CHECK(mfv_get_loads(handle, &loads) == MFV_BAD_ARGUMENT && mfv_get_loads(handle, NULL) == MFV_BAD_ARGUMENT);
  CHECK(mfv_copy(handle, NULL) == MFV_BAD_ARGUMENT && mfv_observe(NULL, watch, NULL) == MFV_BAD_HANDLE);
  CHECK(mfv_has_feature("hdf5", &there) == MFV_COMPLETE && (there == 0 || there == 1));
  CHECK(mfv_has_feature("colour", &there) == MFV_BAD_ARGUMENT && there == 0);
  CHECK(mfv_has_feature(NULL, &there) == MFV_BAD_ARGUMENT && mfv_has_feature("hdf5", NULL) == MFV_BAD_ARGUMENT);
  mfv_free(&handle);
  mfv_free(&other);
  mfv_state_free(&state);
  mfv_scene_free(&scene);
}

int main(void) {
  calls_are_the_text();
  data_in_memory();
  increments();
  newton_by_trial_steps();
  observers();
  success_leaves_the_message();
  misuse_is_told();
  printf(failures == 0 ? "embedding: all checks passed\n" : "embedding: %d checks failed\n", failures);
  return failures != 0;
}
