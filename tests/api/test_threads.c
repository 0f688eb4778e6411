/* Threads that create, run, ask and free cases at the same time get the bytes that one thread alone gets, from good texts
 * and bad ones. Prints what differs; exit code 0 when nothing does. */
#include <mfv.h>
#include <pthread.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { THREADS = 8, ROUNDS = 10, LONGEST = 600 };

#define BODIES                                                                                  \
  "&body shape='half_plane', shear_modulus=1.0, poisson_ratio=0.3, yield_strength=0.01 /\n"     \
  "&body shape='disk', radius=0.25, rigid=.true. /\n"
#define MESH "&mesh nodes=15, half_width=0.0127 /\n"
#define FRICTION "&friction law='coulomb', mu=0.7 /\n"
#define PRESS "&step normal_force=1.0e-3, friction=.false. /\n"

static const char *const texts[] = {
    /* run to the end, with warnings and named units; with moments; with Fourier series; the closed form of Spence */
    "&scene title='sheared', coupling='goodman', length_unit='mm', force_unit='N' /\n" BODIES MESH FRICTION PRESS
    "&step tangential_force=2.8e-4 /\n",
    BODIES MESH FRICTION "&step normal_force=5.0e-4 / &step moment=5.0e-7, cycles=1 /\n",
    "&body shape='disk', radius=1.0, shear_modulus=1.0, poisson_ratio=0.3, kernel='fourier' /\n"
    "&body shape='half_plane', rigid=.true. / &mesh nodes=9, half_angle=20.0 / &step normal_force=0.02 /\n",
    "&body shape='half_plane', shear_modulus=1.0, poisson_ratio=0.3 / &body shape='flat_punch', half_width=1.0, rigid=T /\n"
    "&mesh nodes=12, half_width=1.0 /" FRICTION "&step normal_force=1.0 / &output history='steps' /\n",
    /* end early */
    BODIES MESH FRICTION PRESS "&step tangential_force=1.0e-3 /\n",
    BODIES "&mesh nodes=10, half_width=0.005 / &step normal_force=0.1 /\n",
    /* cannot be used */
    "&scene title='a' /\n&bodi shape='disk' /\n",
    "&body shape='half_plane', shear_modulos=1.0 /\n",
    "&body shape='sphere' /\n",
    "&body shape='disk', radius=-1 /\n",
    "&body shape='disk', radius=1, radius=2 /\n",
    "&body shape='half_plane', poisson_ratio=0.7 /\n",
    BODIES "&mesh nodes=1.5 /\n",
    BODIES MESH "&friction law='coulomb' / &step normal_force=1.0 /\n",
    BODIES MESH FRICTION "&step cycles=2 /\n",
    BODIES "&mesh half_angle=10.0 / &step normal_force=1.0 /\n",
    "&body shape='profile', file='no/such/profile.txt', rigid=.true. / &body shape='disk', radius=1 /\n",
    BODIES MESH "&scene title='not closed /\n",
    BODIES "here is something outside of every group",
    "&mesh nodes=10\n",
};
enum { TEXTS = sizeof texts / sizeof texts[0] };

/* Everything that came out of a text. */
typedef struct {
  char *bytes;
  size_t length, room;
} record;

static void put(record *self, const void *bytes, size_t length) {
  if (self->length + length > self->room) {
    self->room = 2 * (self->length + length);
    self->bytes = realloc(self->bytes, self->room);
  }
  memcpy(self->bytes + self->length, bytes, length);
  self->length += length;
}

static void put_text(record *self, const char *text) { put(self, text, strlen(text) + 1); }

static void put_message(record *self, const mfv_case *handle, int status) {
  char message[LONGEST] = "";
  put(self, &status, sizeof status);
  mfv_message(handle, message, sizeof message);
  put_text(self, message);
}

static void put_field(record *self, const mfv_case *handle, const char *path) {
  char unit[LONGEST] = "", description[LONGEST] = "";
  size_t count = 0;
  int is_integer = -1, along = -1;
  int status = mfv_field_info(handle, path, &count, &is_integer, &along, unit, sizeof unit, description, sizeof description);
  size_t bytes = count * (is_integer ? sizeof(int32_t) : sizeof(double));
  void *values = calloc(1, bytes + 1);
  put_text(self, path);
  put_message(self, handle, status);
  put(self, &is_integer, sizeof is_integer);
  put(self, &along, sizeof along);
  put_text(self, unit);
  put_text(self, description);
  status = is_integer ? mfv_copy_integer(handle, path, values, count) : mfv_copy_real(handle, path, values, count);
  put_message(self, handle, status);
  put(self, values, bytes);
  put_message(self, handle, mfv_copy_real(handle, path, values, count + 1));
  free(values);
}

static void put_attribute(record *self, const mfv_case *handle, const char *name) {
  size_t length = 0;
  mfv_attribute(handle, name, NULL, 0, &length);
  char *text = calloc(1, length + 1);
  int status = mfv_attribute(handle, name, text, length + 1, NULL);
  put_text(self, name);
  put(self, &status, sizeof status);
  put_text(self, text);
  free(text);
}

static void put_case(record *self, mfv_case *handle) {
  char name[LONGEST];
  double place[3];
  size_t fields = 0;
  put_message(self, handle, mfv_run(handle));
  mfv_field_count(handle, &fields);
  for (size_t i = 0; i < fields; ++i)
    if (mfv_field_path(handle, i, name, sizeof name) == MFV_COMPLETE) put_field(self, handle, name);
  put_message(self, handle, mfv_field_path(handle, fields, name, sizeof name));
  for (size_t i = 0; mfv_attribute_name(handle, i, name, sizeof name) == MFV_COMPLETE; ++i) put_attribute(self, handle, name);
  put_message(self, handle, mfv_attribute_name(handle, 99, name, sizeof name));
  put_field(self, handle, "state/presure");
  put_message(self, handle, mfv_stress(handle, MFV_UPPER, 1, 0, NULL, NULL, NULL, place, NULL));
  put_message(self, handle, mfv_stress(handle, MFV_LOWER, 77, 0, NULL, NULL, NULL, place, NULL));
}

static void put_statuses(record *self) {
  char outcome[LONGEST], explanation[LONGEST];
  for (int status = 0; status <= MFV_STATUS_COUNT; ++status) {
    mfv_status_text(status, outcome, sizeof outcome, explanation, sizeof explanation);
    put_text(self, outcome);
    put_text(self, explanation);
  }
}

static record all_of(const char *text) {
  record all = {NULL, 0, 0};
  mfv_case *handle = NULL;
  char message[LONGEST] = "";
  int status = mfv_create_from_text(text, "somewhere/case.nml", &handle, message, sizeof message);
  put(&all, &status, sizeof status);
  put_text(&all, message);
  if (handle != NULL) put_case(&all, handle);
  mfv_free(&handle);
  put_statuses(&all);
  return all;
}

static record alone[TEXTS];

/* Every text, beginning with another one in every thread. Returns the number of texts that gave something else. */
static void *work(void *argument) {
  size_t first = *(size_t *)argument, different = 0;
  for (size_t i = 0; i < ROUNDS * TEXTS; ++i) {
    size_t which = (first + i) % TEXTS;
    record here = all_of(texts[which]);
    different += here.length != alone[which].length || memcmp(here.bytes, alone[which].bytes, here.length) != 0;
    free(here.bytes);
  }
  return (void *)different;
}

/* Many handles alive at once: their loads after every increment, with trial steps, tangents and observers in between. */
enum { HANDLES = 125, INCREMENTS = 6 };

static int count_increments(const mfv_progress *progress, void *user) {
  *(int *)user += progress->contact_nodes > 0;
  return 0;
}

static int by(mfv_case *handle, double shift) {
  mfv_step step = MFV_STEP_INIT;
  step.control[MFV_SHIFT] = MFV_DISPLACEMENT;
  step.target[MFV_SHIFT] = shift;
  step.relative = 1;
  return mfv_advance(handle, &step);
}

/* What one handle gave after every increment. */
typedef struct {
  mfv_loads loads[INCREMENTS];
  double tangent[INCREMENTS][4];
  int increments;
} track;

static int begin(mfv_case **handle, track *seen) {
  static const char *const text = "&body shape='half_plane', shear_modulus=1.0, poisson_ratio=0.2 /\n"
                                  "&body shape='disk', radius=0.25, rigid=.true. / &mesh nodes=15, half_width=0.02 /\n"
                                  "&friction law='coulomb', mu=0.5 / &output history='none', states='none' /\n"
                                  "&step normal_force=1.0e-3 /\n";
  seen->increments = 0;
  if (mfv_create_from_text(text, NULL, handle, NULL, 0) != MFV_COMPLETE || mfv_run(*handle) != MFV_COMPLETE) return 0;
  return mfv_observe(*handle, count_increments, &seen->increments) == MFV_COMPLETE;
}

static int go_on(mfv_case *handle, track *seen, int increment) {
  mfv_state *state = NULL;
  const double size = increment < 4 ? 4e-5 : -5e-5;
  int good = mfv_save(handle, &state) == MFV_COMPLETE && by(handle, -3 * size) == MFV_COMPLETE &&
             mfv_restore(handle, state) == MFV_COMPLETE && by(handle, size) == MFV_COMPLETE;
  mfv_state_free(&state);
  seen->loads[increment] = (mfv_loads)MFV_LOADS_INIT;
  return good && mfv_get_loads(handle, &seen->loads[increment]) == MFV_COMPLETE &&
         mfv_tangent(handle, 2, NULL, seen->tangent[increment]) == MFV_COMPLETE;
}

static track one_track;

/* Advance several handles in turn, increment by increment; returns the number whose result differs from that of a single one. */
static void *lead_many(void *argument) {
  static const size_t everything_failed = HANDLES;
  size_t different = 0;
  mfv_case *handles[HANDLES] = {NULL};
  track *seen = calloc(HANDLES, sizeof *seen);
  (void)argument;
  for (int i = 0; i < HANDLES; ++i)
    if (!begin(&handles[i], &seen[i])) return (void *)everything_failed;
  for (int increment = 0; increment < INCREMENTS; ++increment)
    for (int i = 0; i < HANDLES; ++i)
      if (!go_on(handles[i], &seen[i], increment)) return (void *)everything_failed;
  for (int i = 0; i < HANDLES; ++i) {
    different += memcmp(&seen[i], &one_track, sizeof one_track) != 0;
    mfv_free(&handles[i]);
  }
  free(seen);
  return (void *)different;
}

/* Returns the number of handles, of a thousand in all threads, that did not give the digits of one. */
static size_t thousand_handles(void) {
  pthread_t threads[THREADS];
  size_t failures = 0;
  mfv_case *handle = NULL;
  if (!begin(&handle, &one_track)) return 1;
  for (int increment = 0; increment < INCREMENTS; ++increment)
    if (!go_on(handle, &one_track, increment)) return 1;
  mfv_free(&handle);
  if (one_track.increments <= INCREMENTS || one_track.tangent[0][0] <= 0) return 1;
  for (size_t i = 0; i < THREADS; ++i)
    if (pthread_create(&threads[i], NULL, lead_many, NULL) != 0) return 1;
  for (size_t i = 0; i < THREADS; ++i) {
    void *different = NULL;
    pthread_join(threads[i], &different);
    failures += (size_t)different;
  }
  if (failures > 0) printf("%zu of %d handles gave other digits than one alone\n", failures, THREADS * HANDLES);
  return failures;
}

/* Whether the texts do what they are here for. */
static int as_meant(void) {
  int used = 0, ended = 0, refused = 0;
  for (size_t i = 0; i < TEXTS; ++i) {
    mfv_case *handle = NULL;
    int status = mfv_create_from_text(texts[i], "case.nml", &handle, NULL, 0);
    if (status != MFV_COMPLETE) ++refused;
    else if (mfv_run(handle) == MFV_COMPLETE) ++used;
    else ++ended;
    mfv_free(&handle);
  }
  return used == 4 && ended == 2 && refused == 14;
}

int main(void) {
  pthread_t threads[THREADS];
  size_t first[THREADS], failures = 0;
  if (!as_meant()) {
    printf("the texts do not do what they are here for\n");
    return 1;
  }
  for (size_t i = 0; i < TEXTS; ++i) alone[i] = all_of(texts[i]);
  for (size_t i = 0; i < THREADS; ++i) {
    first[i] = i * TEXTS / THREADS;
    if (pthread_create(&threads[i], NULL, work, &first[i]) != 0) return 1;
  }
  for (size_t i = 0; i < THREADS; ++i) {
    void *different = NULL;
    pthread_join(threads[i], &different);
    if (different != NULL)
      printf("thread %zu: %zu of %d texts gave something else than alone\n", i, (size_t)different, ROUNDS * TEXTS);
    failures += (size_t)different;
  }
  for (size_t i = 0; i < TEXTS; ++i) free(alone[i].bytes);
  failures += thousand_handles();
  return failures != 0;
}
