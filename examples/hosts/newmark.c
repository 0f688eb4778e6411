/* A mass on a frictional contact in time: Newmark's method, and in every time step Newton's, with the contact's consistent tangent.
 *
 * A rigid cylinder of mass m per unit thickness is pressed on a half-plane by a constant force P and slides to the side by U:
 *
 *     m U'' + Q(U) = F(t).
 *
 * MFV computes Q: Coulomb friction with stick and slip zones, so that it depends on the load history, not on U alone. A time step is
 * therefore a trial: the state at its beginning is saved (mfv_save); every iteration restores it (mfv_restore), advances the shift to
 * the new iterate at constant P (mfv_advance), and computes the tangent there (mfv_tangent). The last trial, which satisfies the
 * equation of motion, is kept. Only friction dissipates: Newmark's method with beta = 1/4, gamma = 1/2 (average acceleration) does not.
 *
 * Units: G = 1, R = 1/4; the mass is such that small vibrations of the contact, all of it stuck, have the period 1.
 * Options: newmark --help. Standard output: CSV, a line per time step. Exit codes: 0, 2 for options, 3 when the contact or Newton fails.
 */
#include <getopt.h>
#include <math.h>
#include <mfv.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { NORMAL, TANGENTIAL, MOTIONS }; /* approach with normal force, shift with tangential force */
enum { ITERATIONS = 200 };
static const double PI = 3.141592653589793, TOLERANCE = 1e-11; /* of the residual, relative to mu P and to the first one */
static const double MODULUS = 1.0, RADIUS = 0.25, FORCE = 1.0e-3, MU = 0.7;

typedef struct settings {
  int nodes, steps, normal, initial_stiffness, verbose;
  double poisson_ratio, amplitude, force, periods;
} settings;

typedef struct host {
  mfv_case *contact;
  mfv_state *start; /* of the time step */
  int first;        /* first free motion: NORMAL, or TANGENTIAL at constant normal force */
  double mass, dt;
  double load[MOTIONS]; /* forces on the cylinder, constant in time */
  double position[MOTIONS], velocity[MOTIONS], acceleration[MOTIONS];
  double reaction[MOTIONS];            /* P and Q of the contact */
  double initial[MOTIONS][MOTIONS];    /* tangent with all nodes stuck */
  size_t nodes;
  double *fields; /* buffer for the elastic energy */
} host;

static void stop(const char *what, const char *message) {
  fprintf(stderr, "newmark: %s: %s\n", what, message);
  exit(3);
}

/* Stop if a call fails. */
static void check(const host *self, int status, const char *what) {
  char message[500] = "";
  if (status == MFV_COMPLETE) return;
  mfv_message(self->contact, message, sizeof message);
  stop(what, message);
}

/* ---- the contact ---- */

static void make_contact(host *self, const settings *wanted) {
  mfv_scene *scene = NULL;
  char message[500] = "";
  const double hertz[] = {FORCE, RADIUS, MODULUS, 3.0 - 4.0 * wanted->poisson_ratio};
  double half_width = 0.0;
  mfv_reference("hertz_half_width", 4, hertz, &half_width);
  mfv_scene_create(&scene);
  mfv_scene_set_text(scene, "body(1)%shape", "half_plane");
  mfv_scene_set_real(scene, "body(1)%shear_modulus", MODULUS);
  mfv_scene_set_real(scene, "body(1)%poisson_ratio", wanted->poisson_ratio);
  mfv_scene_set_text(scene, "body(2)%shape", "disk");
  mfv_scene_set_real(scene, "body(2)%radius", RADIUS);
  mfv_scene_set_logical(scene, "body(2)%rigid", 1);
  mfv_scene_set_text(scene, "mesh%gap", "parabolic"); /* as in the closed forms */
  mfv_scene_set_integer(scene, "mesh%nodes", wanted->nodes);
  mfv_scene_set_real(scene, "mesh%half_width", 1.3 * half_width);
  mfv_scene_set_text(scene, "friction%law", "coulomb");
  mfv_scene_set_real(scene, "friction%mu", MU);
  mfv_scene_set_text(scene, "output%history", "none"); /* constant memory, */
  mfv_scene_set_text(scene, "output%states", "none");  /* and any state can be restored */
  if (mfv_create(scene, &self->contact, message, sizeof message) != MFV_COMPLETE) stop("scene", message);
  mfv_scene_free(&scene);
}

static void get_loads(const host *self, mfv_loads *loads) {
  loads->size = sizeof *loads;
  check(self, mfv_get_loads(self->contact, loads), "loads");
}

/* Press, and shear by a force. */
static void load_quasi_statically(host *self, double normal_force, double tangential_force) {
  mfv_step press = MFV_STEP_INIT, shear = MFV_STEP_INIT;
  press.control[MFV_APPROACH] = shear.control[MFV_SHIFT] = MFV_FORCE;
  press.target[MFV_APPROACH] = normal_force;
  press.friction = 0;
  shear.target[MFV_SHIFT] = tangential_force;
  check(self, mfv_advance(self->contact, &press), "press");
  check(self, mfv_advance(self->contact, &shear), "shear");
}

/* Advance the free motions to `position`; without free approach the normal force is constant. */
static void lead(host *self, const double position[MOTIONS]) {
  mfv_step step = MFV_STEP_INIT;
  mfv_loads loads = MFV_LOADS_INIT;
  step.control[MFV_SHIFT] = MFV_DISPLACEMENT;
  step.target[MFV_SHIFT] = position[TANGENTIAL];
  if (self->first == NORMAL) {
    step.control[MFV_APPROACH] = MFV_DISPLACEMENT;
    step.target[MFV_APPROACH] = position[NORMAL];
  }
  check(self, mfv_advance(self->contact, &step), "contact");
  get_loads(self, &loads);
  self->reaction[NORMAL] = loads.force[MFV_APPROACH];
  self->reaction[TANGENTIAL] = loads.force[MFV_SHIFT];
}

/* Derivatives of the reactions with respect to the free motions. At constant P the approach follows the shift by -K_NU/K_NN, which
 * gives the Schur complement. */
static void get_tangent(host *self, const double *direction, double tangent[MOTIONS][MOTIONS]) {
  check(self, mfv_tangent(self->contact, MOTIONS, direction, &tangent[0][0]), "tangent");
  if (self->first == NORMAL) return;
  tangent[TANGENTIAL][TANGENTIAL] -= tangent[TANGENTIAL][NORMAL] * tangent[NORMAL][TANGENTIAL] / tangent[NORMAL][NORMAL];
}

/* Elastic energy, half of tractions times displacements of the surface, less the work of the constant loads. */
static double potential_energy(host *self) {
  static const char *const paths[] = {"mesh/width", "state/pressure", "state/normal_displacement", "state/shear",
                                      "state/tangential_displacement"};
  enum { WIDTH, PRESSURE, NORMAL_DISPLACEMENT, SHEAR, TANGENTIAL_DISPLACEMENT, FIELDS };
  mfv_loads loads;
  double *field[FIELDS], energy = 0.0;
  size_t nodes;
  check(self, mfv_field_info(self->contact, paths[WIDTH], &nodes, NULL, NULL, NULL, 0, NULL, 0), paths[WIDTH]);
  if (nodes > self->nodes) { /* the mesh grows with the contact */
    free(self->fields);
    self->fields = malloc(FIELDS * nodes * sizeof *self->fields);
    if (self->fields == NULL) stop("memory", "not enough");
  }
  self->nodes = nodes;
  for (int i = 0; i < FIELDS; ++i) {
    field[i] = self->fields + (size_t)i * self->nodes;
    check(self, mfv_copy_real(self->contact, paths[i], field[i], self->nodes), paths[i]);
  }
  for (size_t i = 0; i < self->nodes; ++i)
    energy += 0.5 * field[WIDTH][i] *
              (field[PRESSURE][i] * field[NORMAL_DISPLACEMENT][i] + field[SHEAR][i] * field[TANGENTIAL_DISPLACEMENT][i]);
  get_loads(self, &loads);
  return energy - self->load[NORMAL] * loads.motion[MFV_APPROACH] - self->load[TANGENTIAL] * loads.motion[MFV_SHIFT];
}

/* ---- the time step ---- */

/* Newmark's average acceleration at the end of the step, if the position there is this. */
static double acceleration_at(const host *self, int i, double position) {
  return 4.0 * (position - self->position[i] - self->dt * self->velocity[i]) / (self->dt * self->dt) - self->acceleration[i];
}

/* m U'' + Q - F at a trial, and its norm relative to mu P. */
static double residual_at(const host *self, const double position[MOTIONS], double residual[MOTIONS]) {
  double sum = 0.0;
  residual[NORMAL] = 0.0;
  for (int i = self->first; i < MOTIONS; ++i) {
    residual[i] = self->mass * acceleration_at(self, i, position[i]) + self->reaction[i] - self->load[i];
    sum += residual[i] * residual[i];
  }
  return sqrt(sum) / (MU * FORCE);
}

/* position -= (4 m/dt^2 + tangent)^-1 residual */
static void correct(const host *self, double tangent[MOTIONS][MOTIONS], const double residual[MOTIONS], double position[MOTIONS]) {
  const double inertia = 4.0 * self->mass / (self->dt * self->dt);
  const double b = tangent[NORMAL][TANGENTIAL], c = tangent[TANGENTIAL][NORMAL], d = inertia + tangent[TANGENTIAL][TANGENTIAL];
  if (self->first == TANGENTIAL) {
    position[TANGENTIAL] -= residual[TANGENTIAL] / d;
    return;
  }
  const double a = inertia + tangent[NORMAL][NORMAL], determinant = a * d - b * c;
  position[NORMAL] -= (d * residual[NORMAL] - b * residual[TANGENTIAL]) / determinant;
  position[TANGENTIAL] -= (a * residual[TANGENTIAL] - c * residual[NORMAL]) / determinant;
}

/* One time step. The number of iterations is returned. */
static int advance(host *self, const settings *wanted, int number) {
  double position[MOTIONS], residual[MOTIONS], tangent[MOTIONS][MOTIONS];
  double first = 0.0;
  mfv_loads before, now;
  check(self, mfv_save(self->contact, &self->start), "save");
  get_loads(self, &before);
  memcpy(position, self->position, sizeof position);
  for (int iteration = 0; iteration < ITERATIONS; ++iteration) {
    const double size = residual_at(self, position, residual);
    if (wanted->verbose) {
      get_loads(self, &now);
      fprintf(stderr, "%d,%d,%.6e,%d\n", number, iteration, size, now.events - before.events);
    }
    if (iteration == 0) first = size;
    if (size <= TOLERANCE * (1.0 + first)) {
      for (int i = self->first; i < MOTIONS; ++i) {
        const double acceleration = acceleration_at(self, i, position[i]);
        self->velocity[i] += 0.5 * self->dt * (self->acceleration[i] + acceleration);
        self->acceleration[i] = acceleration;
        self->position[i] = position[i];
      }
      return iteration;
    }
    if (wanted->initial_stiffness) {
      memcpy(tangent, self->initial, sizeof tangent);
    } else if (iteration == 0) {
      /* Nothing has moved yet: the direction may change, and the residual gives it. */
      const double direction[MOTIONS] = {-residual[NORMAL], -residual[TANGENTIAL]};
      get_tangent(self, direction, tangent);
    } else {
      get_tangent(self, NULL, tangent);
    }
    correct(self, tangent, residual, position);
    check(self, mfv_restore(self->contact, self->start), "restore");
    lead(self, position);
  }
  stop("iteration", "no convergence");
  return ITERATIONS;
}

/* ---- the program ---- */

static void start(host *self, const settings *wanted) {
  static const double back[MOTIONS] = {0.0, -1.0};
  mfv_loads loads;
  memset(self, 0, sizeof *self);
  self->first = wanted->normal ? NORMAL : TANGENTIAL;
  self->load[NORMAL] = FORCE;
  self->load[TANGENTIAL] = wanted->force * MU * FORCE;
  make_contact(self, wanted);
  load_quasi_statically(self, wanted->normal ? 1.1 * FORCE : FORCE, wanted->amplitude * MU * FORCE);
  get_tangent(self, back, self->initial); /* at a load reversal all nodes stick */
  get_loads(self, &loads);
  self->position[NORMAL] = loads.motion[MFV_APPROACH];
  self->position[TANGENTIAL] = loads.motion[MFV_SHIFT];
  self->reaction[NORMAL] = loads.force[MFV_APPROACH];
  self->reaction[TANGENTIAL] = loads.force[MFV_SHIFT];
  self->mass = self->initial[TANGENTIAL][TANGENTIAL] / (4.0 * PI * PI);
  self->dt = 1.0 / wanted->steps;
  for (int i = self->first; i < MOTIONS; ++i) self->acceleration[i] = (self->load[i] - self->reaction[i]) / self->mass;
}

static void print_line(host *self, double time, int iterations) {
  mfv_loads loads;
  double kinetic = 0.0;
  for (int i = self->first; i < MOTIONS; ++i) kinetic += 0.5 * self->mass * self->velocity[i] * self->velocity[i];
  get_loads(self, &loads);
  printf("%.10g,%.15e,%.15e,%.15e,%.15e,%.15e,%.15e,%.15e,%.15e,%.15e,%d\n", time, loads.motion[MFV_APPROACH],
         loads.motion[MFV_SHIFT], self->velocity[NORMAL], self->velocity[TANGENTIAL], loads.force[MFV_APPROACH],
         loads.force[MFV_SHIFT], kinetic, potential_energy(self), loads.dissipation, iterations);
}

static void run(const settings *wanted) {
  host self;
  const int last = (int)lround(wanted->periods * wanted->steps);
  start(&self, wanted);
  printf("time,approach,shift,approach_velocity,shift_velocity,normal_force,tangential_force,kinetic,potential,dissipation,"
         "iterations\n");
  if (wanted->verbose) fprintf(stderr, "step,iteration,residual,events\n");
  print_line(&self, 0.0, 0);
  for (int number = 1; number <= last; ++number) {
    const int iterations = advance(&self, wanted, number);
    print_line(&self, number * self.dt, iterations);
  }
  mfv_state_free(&self.start);
  mfv_free(&self.contact);
  free(self.fields);
}

static void usage(FILE *stream) {
  fputs("usage: newmark [options]\n"
        "A mass on a frictional contact in time: CSV, a line a time step.\n"
        "  --amplitude X          initial tangential force, part of mu P (0.5)\n"
        "  --force X              tangential force on the mass from t = 0 on, part of mu P (0)\n"
        "  --periods X            how long, in periods of small vibrations (10)\n"
        "  --steps N              time steps a period (50)\n"
        "  --nodes N              nodes of the mesh (101)\n"
        "  --poisson-ratio X      of the half-plane (0.5: pressure and shear do not couple)\n"
        "  --normal               the mass is free to move normally too, and starts pressed by 1.1 P\n"
        "  --initial-stiffness    iterate with the stiffness of the stuck contact in place of the tangent\n"
        "  --verbose              residual of every iteration, part of mu P, with the events on the way there, on standard error\n"
        "  --help\n",
        stream);
}

/* The value of an option. */
static double number_of(const char *text, double least, double most) {
  char *end = NULL;
  const double value = strtod(text, &end);
  if (end == text || *end != '\0' || !(value >= least && value <= most)) {
    fprintf(stderr, "newmark: '%s' is not a number from %g to %g\n", text, least, most);
    exit(2);
  }
  return value;
}

int main(int count, char **arguments) {
  settings wanted = {101, 50, 0, 0, 0, 0.5, 0.5, 0.0, 10.0};
  const struct option options[] = {{"amplitude", required_argument, NULL, 'a'},
                                   {"force", required_argument, NULL, 'f'},
                                   {"periods", required_argument, NULL, 'p'},
                                   {"steps", required_argument, NULL, 's'},
                                   {"nodes", required_argument, NULL, 'n'},
                                   {"poisson-ratio", required_argument, NULL, 'r'},
                                   {"normal", no_argument, &wanted.normal, 1},
                                   {"initial-stiffness", no_argument, &wanted.initial_stiffness, 1},
                                   {"verbose", no_argument, &wanted.verbose, 1},
                                   {"help", no_argument, NULL, 'h'},
                                   {NULL, 0, NULL, 0}};
  for (int option; (option = getopt_long(count, arguments, "", options, NULL)) != -1;) {
    switch (option) {
      case 0: break;
      case 'a': wanted.amplitude = number_of(optarg, -0.99, 0.99); break;
      case 'f': wanted.force = number_of(optarg, -10.0, 10.0); break;
      case 'p': wanted.periods = number_of(optarg, 0.0, 1e6); break;
      case 's': wanted.steps = (int)number_of(optarg, 1.0, 1e6); break;
      case 'n': wanted.nodes = (int)number_of(optarg, 10.0, 1e5); break;
      case 'r': wanted.poisson_ratio = number_of(optarg, 0.0, 0.5); break;
      case 'h': usage(stdout); return 0;
      default: usage(stderr); return 2;
    }
  }
  if (optind < count) {
    usage(stderr);
    return 2;
  }
  run(&wanted);
  return 0;
}
