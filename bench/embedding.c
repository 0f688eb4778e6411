/* Cost of the C interface per step: mfv_advance, with and without mfv_get_loads, against direct calls of the simulation
 * (embedding_direct.f90), in one program.
 *
 *     embedding [REPEATS]                    times: minimum of every increment over this many cycles, alternating (40)
 *     embedding direct|advance|loads SCENE   one way only, a cycle in scene 0, 1, ...: for callgrind to count instructions, such as
 *                                            valgrind --tool=callgrind --toggle-collect=mfv_advance embedding advance 0
 *
 * 85 nodes in contact, Coulomb's friction, a cycle of the shift in small increments, as in embedding.py. Prints a Markdown table. */
#include <malloc.h>
#include <math.h>
#include <mfv.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

int direct_start(const char *text, size_t length);
int direct_advance(double increment);
double direct_force(void);

enum { MOST_INCREMENTS = 400, TEXT = 1000 };
static const double AMPLITUDE = 2.0e-4;

typedef struct scene {
  const char *name, *coupling, *solver, *output;
  int increments; /* of a cycle */
} scene;

static const scene scenes[] = {
    {"Goodman, reduced", "goodman", "reduced", "history='none', states='none'", 400},
    {"Goodman, reduced", "goodman", "reduced", "history='none', states='none'", 80},
    {"Goodman, reduced, history and states kept", "goodman", "reduced", "", 400},
    {"full coupling, reduced", "full", "reduced", "history='none', states='none'", 400},
    {"full coupling, dgesv", "full", "dgesv", "history='none', states='none'", 80},
};
enum { SCENES = sizeof scenes / sizeof scenes[0] };

/* Ways to take an increment, and what else is timed between increments. */
enum { DIRECT, ADVANCE, LOADS, KEEP, TANGENT, WAYS };

static void require(int status, const char *what) {
  if (status == MFV_COMPLETE) return;
  fprintf(stderr, "embedding: %s ends with status %d\n", what, status);
  exit(1);
}

static void write_text(const scene *which, char text[TEXT]) {
  const char *output = which->output;
  snprintf(text, TEXT,
           "&scene coupling='%s' /\n&body shape='half_plane', shear_modulus=1.0, poisson_ratio=0.3 /\n"
           "&body shape='disk', radius=0.25, rigid=.true. /\n&mesh nodes=101, half_width=0.0127 /\n"
           "&friction law='coulomb', mu=0.7 /\n&step normal_force=1.0e-3, friction=.false. /\n"
           "&solver linear_solver='%s' /\n&output file='none.h5'%s%s /\n",
           which->coupling, which->solver, *output ? ", " : "", output);
}

static double seconds(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* Increment `i` of a cycle that begins and ends at no shift. */
static double increment(const scene *which, int i) {
  const double angle = 6.283185307179586 / which->increments;
  return AMPLITUDE * (sin((i + 1) * angle) - sin(i * angle));
}

static mfv_case *pressed(const scene *which) {
  mfv_case *contact = NULL;
  char text[TEXT], message[TEXT] = "";
  write_text(which, text);
  if (mfv_create_from_text(text, NULL, &contact, message, sizeof message) != MFV_COMPLETE) {
    fprintf(stderr, "embedding: %s\n", message);
    exit(1);
  }
  require(mfv_run(contact), "mfv_run");
  return contact;
}

/* One cycle without the C interface; what every increment takes goes to taken[], where that is less. The force at the end. */
static double cycle_direct(const scene *which, double taken[]) {
  char text[TEXT];
  write_text(which, text);
  require(direct_start(text, strlen(text)), "direct_start");
  for (int i = 0; i < which->increments; ++i) {
    const double started = seconds();
    const int status = direct_advance(increment(which, i));
    taken[i] = fmin(taken[i], seconds() - started);
    require(status, "direct_advance");
  }
  return direct_force();
}

/* The same through the C interface. */
static double cycle(const scene *which, int way, double taken[], int *contact_nodes) {
  mfv_case *contact = pressed(which);
  mfv_state *state = NULL;
  mfv_step step = MFV_STEP_INIT;
  mfv_loads loads = MFV_LOADS_INIT;
  double tangent[4];
  step.control[MFV_SHIFT] = MFV_DISPLACEMENT;
  step.relative = 1;
  for (int i = 0; i < which->increments; ++i) {
    step.target[MFV_SHIFT] = increment(which, i);
    double started = seconds();
    int status = mfv_advance(contact, &step);
    if (way == LOADS) status += mfv_get_loads(contact, &loads);
    if (way == KEEP || way == TANGENT) started = seconds();
    if (way == KEEP) status += mfv_save(contact, &state) + mfv_restore(contact, state);
    if (way == TANGENT) status += mfv_tangent(contact, 2, NULL, tangent);
    taken[i] = fmin(taken[i], seconds() - started);
    require(status, "an increment");
  }
  require(mfv_get_loads(contact, &loads), "mfv_get_loads");
  *contact_nodes = loads.contact_nodes;
  mfv_state_free(&state);
  mfv_free(&contact);
  return loads.force[MFV_SHIFT];
}

/* A row of the table: microseconds an increment. */
static void measure(const scene *which, int repeats) {
  static double taken[WAYS][MOST_INCREMENTS];
  double mean[WAYS];
  int contact_nodes = 0;
  for (int way = 0; way < WAYS; ++way)
    for (int i = 0; i < which->increments; ++i) taken[way][i] = INFINITY;
  for (int repeat = 0; repeat < repeats; ++repeat) {
    const double force = cycle_direct(which, taken[DIRECT]);
    for (int way = ADVANCE; way < WAYS; ++way)
      require(cycle(which, way, taken[way], &contact_nodes) != force, "the comparison of forces");
  }
  for (int way = 0; way < WAYS; ++way) {
    mean[way] = 0.0;
    for (int i = 0; i < which->increments; ++i) mean[way] += 1e6 * taken[way][i] / which->increments;
  }
  printf("| %s | %d | %d | %.2f | %.2f | %.2f %% | %.2f %% | %.0f %% | %.0f %% |\n", which->name, contact_nodes, which->increments,
         mean[DIRECT], mean[ADVANCE], 100 * (mean[ADVANCE] / mean[DIRECT] - 1), 100 * (mean[LOADS] / mean[DIRECT] - 1),
         100 * mean[KEEP] / mean[DIRECT], 100 * mean[TANGENT] / mean[DIRECT]);
  fflush(stdout);
}

int main(int count, char **arguments) {
  static double taken[MOST_INCREMENTS];
  int contact_nodes;
  /* Memory that was freed stays with the process: else what one way gives back the other one pays for. */
  mallopt(M_MMAP_THRESHOLD, 1 << 30);
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
  if (count == 3) {
    const int number = atoi(arguments[2]) % SCENES, way = strcmp(arguments[1], "loads") == 0 ? LOADS : ADVANCE;
    if (strcmp(arguments[1], "direct") == 0)
      cycle_direct(&scenes[number], taken);
    else
      cycle(&scenes[number], way, taken, &contact_nodes);
    return 0;
  }
  puts("| scene | nodes in contact | increments a cycle | directly, µs | mfv_advance, µs | more | with mfv_get_loads | "
       "mfv_save and mfv_restore | mfv_tangent |\n| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |");
  for (int i = 0; i < SCENES; ++i) measure(&scenes[i], count == 2 ? atoi(arguments[1]) : 40);
  return 0;
}
