/* See random_case.h. What scenes are like is as in tests/support/random_scenes.f90: laws, couplings, materials, shapes, steps of forces,
 * displacements and moments; beside them the ways to the solution, profiles in memory, and coefficients along the surface. */
#include "random_case.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

const char *const law_names[LAWS] = {"none", "coulomb", "static_kinetic", "weakening", "dahl"};
const char *const way_names[WAYS] = {"auto", "dgesv", "reduced", "fft", "nominal", "leap", "explicit", "conventional"};
enum { AUTO, DGESV, REDUCED, FFT, NOMINAL, LEAP, EXPLICIT, CONVENTIONAL };
enum { NO_FRICTION, COULOMB, STATIC_KINETIC, WEAKENING, DAHL };

static uint64_t next_bits(generator *random) {
  uint64_t bits = random->state += 0x9e3779b97f4a7c15ULL;
  bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9ULL;
  bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebULL;
  return bits ^ (bits >> 31);
}

generator generator_of(uint64_t seed, uint64_t number) {
  generator of_seed = {seed}, of_number = {next_bits(&of_seed) + number};
  return (generator){next_bits(&of_number)};
}

double between(generator *random, double low, double high) {
  return low + (high - low) * (double)(next_bits(random) >> 11) / 9007199254740992.0;
}

int one_of(generator *random, int count) { return (int)between(random, 0, count); }

int chance(generator *random, double probability) { return between(random, 0, 1) < probability; }

/* --- keys --- */

static entry *new_entry(random_case *self, const char *group, int number, const char *key, entry_kind kind) {
  entry *new = &self->entries[self->count++];
  if (self->count == MOST_ENTRIES) abort();
  new->group = group;
  new->number = number;
  new->key = key;
  new->kind = kind;
  return new;
}

static void put_real(random_case *self, const char *group, int number, const char *key, double value) {
  new_entry(self, group, number, key, A_REAL)->value = value;
}

static void put_integer(random_case *self, const char *group, int number, const char *key, int value) {
  new_entry(self, group, number, key, AN_INTEGER)->value = value;
}

static void put_logical(random_case *self, const char *group, int number, const char *key, int value) {
  new_entry(self, group, number, key, A_LOGICAL)->value = value;
}

static void put_text(random_case *self, const char *group, int number, const char *key, const char *value) {
  snprintf(new_entry(self, group, number, key, A_TEXT)->text, sizeof(((entry *)0)->text), "%s", value);
}

static void put_list(random_case *self, const char *group, int number, const char *key, const double *list) {
  new_entry(self, group, number, key, A_LIST)->list = list;
}

/* --- bodies --- */

/* What an elastic body adds to the compliance 1/E*; it becomes elastic. */
static double make_elastic(generator *random, random_case *self, int body, int plane_stress, double datum) {
  double modulus = pow(10, between(random, -3, 3)), ratio = between(random, -0.9, 0.5);
  put_real(self, "body", body, "shear_modulus", modulus);
  put_real(self, "body", body, "poisson_ratio", ratio);
  if (datum > 0) put_real(self, "body", body, "datum", datum);
  if (chance(random, 0.2)) put_real(self, "body", body, "yield_strength", modulus * pow(10, between(random, -4, -1)));
  return plane_stress ? 1 / (2 * modulus * (1 + ratio)) : (1 - ratio) / (2 * modulus);
}

static void put_profile(random_case *self, generator *random, double radius) {
  double bumps = chance(random, 0.5) ? between(random, 0, 0.2) : 0, reach = 4 * self->half_width;
  self->has_profile = 1;
  for (int i = 0; i < PROFILE_POINTS; ++i) {
    double x = reach * (2.0 * i / (PROFILE_POINTS - 1) - 1);
    self->profile_x[i] = x;
    self->profile_height[i] =
        x * x / (2 * radius) + bumps * self->half_width * self->half_width / radius * (1 - cos(6 * x / self->half_width));
  }
}

/* Both bodies, the mesh, and what a contact of them is like. */
static void choose_bodies(generator *random, random_case *self, int plane_stress) {
  double radius = pow(10, between(random, -2, 2)), curvature = 1 / radius, compliance = 0, hole = 0, other = 0;
  int shapes = one_of(random, 9), lower_is_half_plane = shapes != 2 && shapes != 3 && shapes != 4 && shapes != 5;
  self->half_width = between(random, 0.02, 0.08) * radius;
  if (shapes == 4 || shapes == 5) hole = between(random, 1.3, 3) * radius;
  if (shapes == 3) other = between(random, 1, 2) * radius;

  if (shapes == 2) other = radius;
  put_text(self, "body", 1, "shape", hole > 0 ? "hole" : other > 0 ? "disk" : "half_plane");
  if (hole > 0) put_real(self, "body", 1, "radius", hole);
  if (other > 0) put_real(self, "body", 1, "radius", other);
  compliance += make_elastic(random, self, 1, plane_stress, lower_is_half_plane ? radius : 0);
  if (shapes == 6) {
    put_text(self, "body", 2, "shape", "flat_punch");
    put_real(self, "body", 2, "half_width", self->half_width);
    put_logical(self, "body", 2, "rigid", 1);
  } else if (shapes == 7) {
    put_text(self, "body", 2, "shape", "profile");
    put_text(self, "body", 2, "file", "profile in memory");
    put_logical(self, "body", 2, "rigid", 1);
    put_profile(self, random, radius);
  } else {
    put_text(self, "body", 2, "shape", shapes == 2 ? "half_plane" : "disk");
    if (shapes != 2) put_real(self, "body", 2, "radius", radius);
    if (shapes != 2 && chance(random, 0.5)) compliance += make_elastic(random, self, 2, plane_stress, 0);
    else put_logical(self, "body", 2, "rigid", 1);
  }
  if (hole > 0) curvature -= 1 / hole;
  if (shapes == 3) curvature += 1 / other;
  self->radius = lower_is_half_plane ? 0 : radius;

  self->nodes = chance(random, 0.04) ? 100 + one_of(random, 150) : 11 + one_of(random, 30);
  put_integer(self, "mesh", 0, "nodes", self->nodes);
  int fixed = shapes == 6 || shapes == 7 || chance(random, 0.5);
  if (fixed) put_real(self, "mesh", 0, "half_width", (shapes == 6 ? 1 : shapes == 7 ? 2 : 1.4) * self->half_width);
  if (hole > 0 && chance(random, 0.2)) put_text(self, "mesh", 0, "normals", "radial");
  else if (shapes < 6 && chance(random, 0.3)) put_text(self, "mesh", 0, "gap", "parabolic");
  if (shapes == 6) self->force = between(random, 0.001, 0.01) / compliance * self->half_width;
  else self->force = 0.25 * pi / compliance * self->half_width * self->half_width * curvature;
  self->approach = self->force * compliance / pi * 2 * (0.5 + log(2 * radius / self->half_width));
  self->mesh_stays = fixed;
  self->modulus = 1 / compliance;
}

/* --- friction --- */

static void put_coefficient(random_case *self, const char *key, double value, int varies) {
  if (!varies) {
    put_real(self, "friction", 0, key, value);
    return;
  }
  double *list = self->coefficients;
  if (list == NULL) list = self->coefficients = calloc(2 * (size_t)self->nodes, sizeof *list);
  else list += self->nodes;
  for (int i = 0; i < self->nodes; ++i) list[i] = value * (1.2 - 0.4 * i / self->nodes);
  put_list(self, "friction", 0, key, list);
}

static void choose_friction(generator *random, random_case *self) {
  static const int laws[9] = {NO_FRICTION, COULOMB, COULOMB, COULOMB, STATIC_KINETIC, STATIC_KINETIC, WEAKENING, WEAKENING, DAHL};
  double mu = pow(10, between(random, -1.3, 0.3)), kinetic = mu * between(random, 0.6, 1), part = pow(10, between(random, -1, 2));
  int varies = self->mesh_stays && chance(random, 0.2);
  self->law = laws[one_of(random, 9)];
  self->mu = mu;
  self->shift = mu * self->approach;
  put_text(self, "friction", 0, "law", law_names[self->law]);
  if (self->law == COULOMB || self->law == DAHL) put_coefficient(self, "mu", mu, varies);
  if (self->law == STATIC_KINETIC || self->law == WEAKENING) {
    put_coefficient(self, "mu_static", mu, varies);
    put_coefficient(self, "mu_kinetic", kinetic, varies);
  }
  if (self->law == WEAKENING) put_real(self, "friction", 0, "weakening_distance", part * mu * self->force / self->modulus);
  if (self->law == DAHL) {
    put_real(self, "friction", 0, "stiffness", 10 * part * self->modulus / self->half_width);
    put_real(self, "friction", 0, "exponent", 0.5 * one_of(random, 5));
  }
}

/* --- the way to the solution, and what is kept --- */

static void choose_way(generator *random, random_case *self) {
  int way = chance(random, 0.5) ? AUTO : one_of(random, WAYS), linear = self->law <= STATIC_KINETIC;
  if (way == LEAP && self->law > COULOMB) way = REDUCED;
  if ((way == NOMINAL || way == CONVENTIONAL) && !linear) way = DGESV;
  if (way == EXPLICIT && self->law != DAHL) way = AUTO;
  self->way = way;
  /* Weakening and Dahl: the length of an increment, to which their lines of friction belong, is found to 1e-9 of it (same_step in
     increment.f90). */
  self->limit = way == FFT || self->law >= WEAKENING ? 1e-8 : 1e-9;
  if (way == DGESV || way == REDUCED || way == FFT) put_text(self, "solver", 0, "linear_solver", way_names[way]);
  if (way == NOMINAL || way == LEAP) put_text(self, "solver", 0, "stepping", way_names[way]);
  if (way == LEAP) put_real(self, "solver", 0, "accuracy", 1e-2);
  if (way == EXPLICIT) put_text(self, "solver", 0, "integration", "explicit");
  if (way == CONVENTIONAL) put_text(self, "solver", 0, "algorithm", "conventional");
  if (self->law >= WEAKENING && way != EXPLICIT) put_real(self, "solver", 0, "friction_tolerance", 1e-2);

  static const char *const histories[3] = {"events", "steps", "none"}, *const states[3] = {"reversals", "steps", "none"};
  int history = one_of(random, 3), kept = chance(random, 0.5) ? history : one_of(random, 3);
  put_text(self, "output", 0, "history", histories[history]);
  put_text(self, "output", 0, "states", states[kept]);
  self->free_states = history == 2 && kept == 2;
}

/* --- steps --- */

static mfv_step random_step(generator *random, const random_case *self, int is_first, double *normal) {
  mfv_step step = MFV_STEP_INIT;
  int friction = self->law != NO_FRICTION;
  if (is_first || !friction || chance(random, 0.4)) {
    *normal = is_first ? 1 : chance(random, 0.05) ? 0 : between(random, 0.1, 1.2);
    step.control[MFV_APPROACH] = chance(random, 0.8) ? MFV_FORCE : MFV_DISPLACEMENT;
    step.target[MFV_APPROACH] = *normal * (step.control[MFV_APPROACH] == MFV_FORCE ? self->force : self->approach);
  }
  if (friction && (chance(random, is_first ? 0.2 : 0.7) || (!is_first && step.control[MFV_APPROACH] == MFV_KEEP))) {
    step.control[MFV_SHIFT] = chance(random, 0.8) ? MFV_FORCE : MFV_DISPLACEMENT;
    step.target[MFV_SHIFT] = between(random, -1, 1) * fmin(*normal, 1) *
                             (step.control[MFV_SHIFT] == MFV_FORCE ? self->mu * self->force : self->shift);
  }
  if (is_first && step.control[MFV_SHIFT] == MFV_KEEP) step.friction = chance(random, 0.2);
  if (!is_first && chance(random, 0.3)) {
    step.cycles = 1 + one_of(random, 3);
    if (step.cycles > 1 && chance(random, 0.5)) step.steady_tolerance = 1e-6;
  }
  if (!is_first && friction && self->radius > 0 && chance(random, 0.2)) {
    step.control[MFV_ROTATION] = MFV_FORCE;
    step.target[MFV_ROTATION] = between(random, -0.3, 0.3) * *normal * self->force * self->half_width;
  }
  generator apart = generator_of(random->state, 1); /* other steps are what they are without bulk stresses */
  if (friction && !(self->radius > 0) && chance(&apart, 0.2)) {
    step.control[MFV_LOWER_BULK_STRESS] = MFV_DISPLACEMENT;
    step.target[MFV_LOWER_BULK_STRESS] =
        between(&apart, -1, 1) * pow(10, between(&apart, -1, 1)) * self->mu * self->force / self->half_width;
  }
  return step;
}

static void put_step(random_case *self, int number, const mfv_step *step) {
  static const char *keys[][MFV_MOTIONS] = {[MFV_FORCE] = {"normal_force", "tangential_force", "moment"},
                                            [MFV_DISPLACEMENT] = {"approach", "shift", "rotation", "lower_bulk_stress", NULL}};
  for (int i = 0; i < MFV_MOTIONS; ++i)
    if (step->control[i] != MFV_KEEP) put_real(self, "step", number, keys[step->control[i]][i], step->target[i]);
  if (self->law != NO_FRICTION) put_logical(self, "step", number, "friction", step->friction);
  if (step->cycles > 0) put_integer(self, "step", number, "cycles", step->cycles);
  if (step->steady_tolerance > 0) put_real(self, "step", number, "steady_tolerance", step->steady_tolerance);
}

/* Steps in the text, the first of which presses, and steps to be led by mfv_advance. */
static void choose_steps(generator *random, random_case *self) {
  double normal = 1;
  self->steps = 1 + one_of(random, 3);
  self->lead_count = one_of(random, MOST_STEPS - 2);
  for (int i = 0; i < self->steps + self->lead_count; ++i) {
    mfv_step step = random_step(random, self, i == 0, &normal);
    if (i < self->steps) put_step(self, i + 1, &step);
    else self->leads[i - self->steps] = step;
  }
}

random_case *new_random_case(generator *random) {
  static const char *const couplings[4] = {"full", "full", "goodman", "none"};
  random_case *self = calloc(1, sizeof *self);
  int plane_stress = chance(random, 0.3);
  put_text(self, "scene", 0, "plane", plane_stress ? "stress" : "strain");
  put_text(self, "scene", 0, "coupling", couplings[one_of(random, 4)]);
  choose_bodies(random, self, plane_stress);
  choose_friction(random, self);
  choose_way(random, self);
  choose_steps(random, self);
  return self;
}

void free_random_case(random_case *self) {
  free(self->coefficients);
  free(self);
}

static void write_entry(const random_case *self, const entry *this, char *text, size_t size) {
  size_t used = 0;
  switch (this->kind) {
    case A_TEXT: snprintf(text, size, "%s='%s'", this->key, this->text); return;
    case A_REAL: snprintf(text, size, "%s=%.17g", this->key, this->value); return;
    case AN_INTEGER: snprintf(text, size, "%s=%d", this->key, (int)this->value); return;
    case A_LOGICAL: snprintf(text, size, "%s=%s", this->key, this->value != 0 ? ".true." : ".false."); return;
    case A_LIST:
      used = (size_t)snprintf(text, size, "%s=", this->key);
      for (int i = 0; i < self->nodes; ++i)
        used += (size_t)snprintf(text + used, size - used, "%s%.17g", i > 0 ? "," : "", this->list[i]);
  }
}

void text_of_case(const random_case *self, char *text) {
  char *end = text, *const last = text + LONGEST_TEXT;
  for (int i = 0; i < self->count; ++i) {
    const entry *this = &self->entries[i], *before = this - 1;
    int is_new = i == 0 || strcmp(this->group, before->group) != 0 || this->number != before->number;
    if (is_new) end += snprintf(end, (size_t)(last - end), "%s&%s ", i > 0 ? " /\n" : "", this->group);
    else end += snprintf(end, (size_t)(last - end), ", ");
    write_entry(self, this, end, (size_t)(last - end));
    end += strlen(end);
  }
  snprintf(end, (size_t)(last - end), " /\n");
}

static int set_entry(const random_case *self, mfv_scene *scene, const entry *this) {
  char name[60];
  if (this->number > 0) snprintf(name, sizeof name, "%s(%d)%%%s", this->group, this->number, this->key);
  else snprintf(name, sizeof name, "%s%%%s", this->group, this->key);
  switch (this->kind) {
    case A_TEXT: return mfv_scene_set_text(scene, name, this->text);
    case A_REAL: return mfv_scene_set_real(scene, name, this->value);
    case AN_INTEGER: return mfv_scene_set_integer(scene, name, (int)this->value);
    case A_LOGICAL: return mfv_scene_set_logical(scene, name, this->value != 0);
    case A_LIST: return mfv_scene_set_reals(scene, name, this->list, (size_t)self->nodes);
  }
  return MFV_BAD_ARGUMENT;
}

int scene_of_case(const random_case *self, mfv_scene **scene) {
  static const char *const file = "profile in memory";
  int status = mfv_scene_create(scene);
  for (int i = 0; i < self->count && status == MFV_COMPLETE; ++i) status = set_entry(self, *scene, &self->entries[i]);
  if (status == MFV_COMPLETE && self->has_profile) {
    status = mfv_scene_set_data(*scene, file, "x", PROFILE_POINTS, 1, self->profile_x);
    if (status == MFV_COMPLETE) status = mfv_scene_set_data(*scene, file, "height", PROFILE_POINTS, 1, self->profile_height);
  }
  return status;
}
