/* See life.h. A case is made in one of four ways, run, led on by steps, tried and taken back, asked, copied, written, freed. What must
 * hold: the statuses are those that the library names, loads are finite, the certificate is small, what is taken back is
 * back to the last digit. */
#include "life.h"
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Runs that chatter are stopped after this number of increments, as in tests/support/random_scenes.f90. */
enum { PATIENCE = 400, LONGEST_MESSAGE = 2000 };

typedef struct {
  generator random;
  random_case *made;
  mfv_case *handle;
  const char *folder;
  FILE *diary;
  int increments, stop_at;
  life out;
} story;

/* A line of the diary: a comment of the text. */
static void note(story *self, const char *format, ...) {
  va_list arguments;
  if (self->diary == NULL) return;
  va_start(arguments, format);
  fprintf(self->diary, "! ");
  vfprintf(self->diary, format, arguments);
  fprintf(self->diary, "\n");
  va_end(arguments);
}

static void wrong(story *self, const char *format, ...) {
  va_list arguments;
  if (self->out.why[0] != '\0') return;
  va_start(arguments, format);
  vsnprintf(self->out.why, sizeof self->out.why, format, arguments);
  va_end(arguments);
  note(self, "WRONG: %s", self->out.why);
}

/* FNV-1a. */
static void add(story *self, const void *bytes, size_t length) {
  const unsigned char *byte = bytes;
  for (size_t i = 0; i < length; ++i) self->out.digits = (self->out.digits ^ byte[i]) * 0x100000001b3ULL;
}

static int watch(const mfv_progress *progress, void *user) {
  story *self = user;
  add(self, progress, sizeof *progress);
  return ++self->increments >= self->stop_at;
}

static mfv_loads loads_now(story *self) {
  mfv_loads loads = MFV_LOADS_INIT;
  if (mfv_get_loads(self->handle, &loads) != MFV_COMPLETE) wrong(self, "mfv_get_loads failed");
  double sum = loads.dissipation;
  for (int i = 0; i < MFV_MOTIONS; ++i) sum += loads.force[i] + loads.motion[i];
  if (!isfinite(sum)) wrong(self, "a load is not finite");
  return loads;
}

/* Whether it is an outcome that the way to the solution can have. */
static int is_named(const story *self, int status) {
  static const int named[] = {MFV_COMPLETE,      MFV_INTERRUPTED, MFV_GROSS_SLIDING, MFV_NO_CONTINUATION,
                              MFV_MESH_EXCEEDED, MFV_SEPARATED,   MFV_INADMISSIBLE_STEP};
  for (size_t i = 0; i < sizeof named / sizeof named[0]; ++i)
    if (status == named[i]) return 1;
  return self->made->way + 1 == WAYS && (status == MFV_CYCLING || status == MFV_INADMISSIBLE);
}

/* Keep and judge what a lead has returned. */
static void led(story *self, int status) {
  char message[LONGEST_MESSAGE] = "";
  mfv_message(self->handle, message, sizeof message);
  if (!is_named(self, status)) wrong(self, "the outcome is %d: %s", status, message);
  if (message[0] == '\0') wrong(self, "the outcome %d has no message", status);
  self->out.status = status;
  mfv_loads loads = loads_now(self);
  if (self->diary != NULL) {
    double certificate = NAN;
    mfv_copy_real(self->handle, "certificate/largest", &certificate, 1);
    note(self, "outcome %d, %d increments so far, certificate %.2g: %s", status, self->increments, certificate, message);
  }
  add(self, &status, sizeof status);
  add(self, message, strlen(message));
  add(self, &loads, sizeof loads);
}

/* --- making a case --- */

static void spoil(generator *random, char *text) {
  for (int i = 1 + one_of(random, 4); i > 0; --i) {
    size_t length = strlen(text), at = (size_t)between(random, 0, (double)length);
    if (chance(random, 0.4)) memmove(text + at, text + at + 1, length - at); /* a character less */
    else if (chance(random, 0.2)) text[at] = '\0';
    else text[at] = (char)(1 + one_of(random, 255));
  }
}

static int made_by_text(story *self, const char *text, char *message) {
  mfv_scene *scene = NULL;
  if (chance(&self->random, 0.6)) return mfv_create_from_text(text, "soak.nml", &self->handle, message, LONGEST_MESSAGE);
  int status = mfv_scene_from_text(text, "soak.nml", &scene, message, LONGEST_MESSAGE);
  if (status == MFV_COMPLETE) status = mfv_create(scene, &self->handle, message, LONGEST_MESSAGE);
  mfv_scene_free(&scene);
  return status;
}

static int made_by_calls(story *self, char *message) {
  mfv_scene *scene = NULL;
  int status = scene_of_case(self->made, &scene);
  if (status == MFV_COMPLETE) status = mfv_create(scene, &self->handle, message, LONGEST_MESSAGE);
  mfv_scene_free(&scene);
  return status;
}

static void make(story *self) {
  char *text = malloc(LONGEST_TEXT), message[LONGEST_MESSAGE] = "";
  int status;
  self->made = new_random_case(&self->random);
  text_of_case(self->made, text);
  self->out.was_bad = chance(&self->random, 0.15);
  if (self->out.was_bad) {
    spoil(&self->random, text);
    status = made_by_text(self, text, message);
  } else {
    status = self->made->has_profile || chance(&self->random, 0.4) ? made_by_calls(self, message) : made_by_text(self, text, message);
  }
  if (self->diary != NULL) fprintf(self->diary, "%s", text);
  note(self, "made with outcome %d %s", status, message);
  add(self, &status, sizeof status);
  add(self, message, strlen(message));
  self->out.law = self->made->law;
  self->out.way = self->made->way;
  self->out.status = status;
  if (status != MFV_COMPLETE && status != MFV_INPUT_ERROR) wrong(self, "the making returned %d: %s", status, message);
  if (status != MFV_COMPLETE && message[0] == '\0') wrong(self, "the making returned %d without a message", status);
  if ((status == MFV_COMPLETE) != (self->handle != NULL)) wrong(self, "the making returned %d with handle %p", status, (void *)self->handle);
  if (status != MFV_COMPLETE && !self->out.was_bad) wrong(self, "a good case was refused: %s", message);
  free(text);
}

/* --- leading it --- */

/* How long the next lead may go on. */
static void be_patient(story *self) {
  self->stop_at = chance(&self->random, 0.15) ? self->increments + 1 + one_of(&self->random, 30) : PATIENCE;
  note(self, "stopped at increment %d", self->stop_at);
}

/* A step, whole or by parts relative to the loads now. */
static void lead(story *self, const mfv_step *step) {
  mfv_step part = *step;
  /* Without force there is no part of it that round-off could not make negative. */
  int lifts = step->control[MFV_APPROACH] == MFV_FORCE && step->target[MFV_APPROACH] == 0;
  int parts = step->cycles == 0 && !lifts && chance(&self->random, 0.3) ? 2 + one_of(&self->random, 4) : 1;
  mfv_loads now = loads_now(self);
  be_patient(self);
  if (parts > 1) {
    part.relative = 1;
    for (int i = 0; i < MFV_MOTIONS; ++i)
      part.target[i] = (step->target[i] - (step->control[i] == MFV_FORCE ? now.force[i] : now.motion[i])) / parts;
  }
  for (int i = 0; i < parts; ++i) {
    if (i + 1 == parts && parts > 1) part = *step; /* round-off must not make the force negative */
    note(self, "advance normal %d %.17g tangential %d %.17g rotational %d %.17g bulk %d %.17g friction %d cycles %d steady %g relative %d",
         part.control[MFV_APPROACH], part.target[MFV_APPROACH], part.control[MFV_SHIFT], part.target[MFV_SHIFT],
         part.control[MFV_ROTATION], part.target[MFV_ROTATION], part.control[MFV_LOWER_BULK_STRESS],
         part.target[MFV_LOWER_BULK_STRESS], part.friction, part.cycles, part.steady_tolerance, part.relative);
    led(self, mfv_advance(self->handle, &part));
    if (self->out.status != MFV_COMPLETE) return;
  }
}

/* Lead somewhere and come back: the loads must be the same to the last digit. */
static void try_and_take_back(story *self, mfv_state **state, const mfv_step *step) {
  mfv_loads before = loads_now(self);
  if (mfv_save(self->handle, state) != MFV_COMPLETE) wrong(self, "mfv_save failed");
  int outcome = self->out.status;
  note(self, "saved");
  lead(self, step);
  note(self, "restored");
  if (mfv_restore(self->handle, *state) != MFV_COMPLETE) wrong(self, "mfv_restore failed");
  mfv_loads after = loads_now(self);
  if (memcmp(&before, &after, sizeof before) != 0) wrong(self, "what was taken back is not as before");
  self->out.status = outcome;
}

static void ask_for_tangent(story *self) {
  double tangent[9] = {0}, direction[3] = {between(&self->random, -1, 1), between(&self->random, -1, 1), 0};
  int motions = 2 + chance(&self->random, 0.3), sum_is_finite = 1;
  int towards = chance(&self->random, 0.5), status = mfv_tangent(self->handle, motions, towards ? direction : NULL, tangent);
  note(self, "tangent of %d motions towards %g %g: %d", motions, towards ? direction[0] : NAN, towards ? direction[1] : NAN, status);
  for (int i = 0; i < motions * motions; ++i) sum_is_finite = sum_is_finite && isfinite(tangent[i]);
  int is_known = status == MFV_COMPLETE || status == MFV_BAD_ARGUMENT || (towards && is_named(self, status));
  if (!is_known) wrong(self, "mfv_tangent returned %d", status);
  if (status == MFV_COMPLETE && !sum_is_finite) wrong(self, "the tangent is not finite");
  add(self, &status, sizeof status);
  if (status == MFV_COMPLETE) add(self, tangent, sizeof tangent);
}

/* Lead on what is left; an observer that ended the last step wants no more than that. */
static void lead_on(story *self) {
  mfv_state *state = NULL;
  for (int i = 0; i < self->made->lead_count; ++i) {
    if (self->out.status != MFV_COMPLETE && self->out.status != MFV_INTERRUPTED) break;
    if (self->increments >= PATIENCE) break;
    if (chance(&self->random, 0.3)) try_and_take_back(self, &state, &self->made->leads[i]);
    if (chance(&self->random, 0.3)) ask_for_tangent(self);
    lead(self, &self->made->leads[i]);
  }
  mfv_state_free(&state);
}

/* --- asking it --- */

static void ask_for_fields(story *self) {
  char path[200];
  size_t fields = 0;
  mfv_field_count(self->handle, &fields);
  for (size_t i = 0; i < fields; ++i) {
    size_t count = 0;
    int is_integer = 0;
    if (mfv_field_path(self->handle, i, path, sizeof path) != MFV_COMPLETE ||
        mfv_field_info(self->handle, path, &count, &is_integer, NULL, NULL, 0, NULL, 0) != MFV_COMPLETE) {
      wrong(self, "field %zu cannot be asked for", i);
      return;
    }
    void *values = calloc(count, sizeof(double));
    int status = is_integer ? mfv_copy_integer(self->handle, path, values, count) : mfv_copy_real(self->handle, path, values, count);
    if (status != MFV_COMPLETE) wrong(self, "%s cannot be copied", path);
    if (strstr(path, "seconds") == NULL && strstr(path, "time") == NULL) add(self, values, count * sizeof(double));
    free(values);
  }
}

static void ask_for_stresses(story *self) {
  double place[3] = {0}, x = 0, y = -self->made->half_width, stresses[MFV_STRESS_COUNT];
  int body = one_of(&self->random, 2), status = mfv_stress(self->handle, body, 0, 0, NULL, NULL, NULL, place, NULL);
  if (status != MFV_COMPLETE && status != MFV_BAD_ARGUMENT) wrong(self, "mfv_stress returned %d", status);
  if (status == MFV_COMPLETE && !isfinite(place[0])) wrong(self, "the largest von Mises stress is not finite");
  if (status == MFV_COMPLETE && mfv_stress(self->handle, body, 0, 1, &x, &y, stresses, NULL, NULL) != MFV_COMPLETE) wrong(self, "mfv_stress failed");
  add(self, place, sizeof place);
}

static void write_it(story *self) {
  char path[300];
  snprintf(path, sizeof path, "%s/soak-%ld-%p.h5", self->folder, (long)getpid(), (void *)self);
  int there = 0, status = mfv_write(self->handle, path);
  mfv_has_feature("hdf5", &there);
  if (there && status != MFV_COMPLETE) wrong(self, "mfv_write returned %d", status);
  remove(path);
}

static void ask(story *self) {
  char message[LONGEST_MESSAGE] = ""; /* of the run: a question that is refused has another */
  mfv_message(self->handle, message, sizeof message);
  if (chance(&self->random, 0.2)) ask_for_fields(self);
  if (chance(&self->random, 0.1)) ask_for_stresses(self);
  if (chance(&self->random, 0.02)) write_it(self);
  if (mfv_copy_real(self->handle, "certificate/largest", &self->out.certificate, 1) != MFV_COMPLETE) wrong(self, "no certificate");
  self->out.was_told = self->out.status == MFV_NO_CONTINUATION && strstr(message, "no longer satisfied") != NULL;
  if (!(self->out.certificate <= self->made->limit) && !self->out.was_bad && !self->out.was_told)
    wrong(self, "the certificate is %.3g, outcome %d", self->out.certificate, self->out.status);
  add(self, &self->out.certificate, sizeof self->out.certificate);
}

life live(uint64_t seed, uint64_t number, const char *folder, FILE *diary) {
  story self = {.random = generator_of(seed, number), .folder = folder, .diary = diary};
  mfv_case *copy = NULL;
  self.out.digits = 0xcbf29ce484222325ULL;
  self.out.certificate = NAN;
  make(&self);
  if (self.handle != NULL) {
    mfv_observe(self.handle, watch, &self);
    be_patient(&self);
    led(&self, mfv_run(self.handle));
    if (chance(&self.random, 0.1)) {
      note(&self, "the copy goes on in its place");
      if (mfv_copy(self.handle, &copy) != MFV_COMPLETE) wrong(&self, "mfv_copy failed");
      mfv_free(&self.handle);
      self.handle = copy;
      mfv_observe(self.handle, watch, &self);
    }
    lead_on(&self);
    ask(&self);
    mfv_free(&self.handle);
  }
  free_random_case(self.made);
  return self.out;
}
