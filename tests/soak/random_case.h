/* Random cases, the same ones everywhere: a case by a seed and its number. */
#ifndef RANDOM_CASE_H
#define RANDOM_CASE_H

#include <mfv.h>
#include <stddef.h>
#include <stdint.h>

/* splitmix64 (Steele, Lea and Flood 2014). */
typedef struct {
  uint64_t state;
} generator;

generator generator_of(uint64_t seed, uint64_t number);
double between(generator *random, double low, double high);
int one_of(generator *random, int count); /* 0 .. count - 1 */
int chance(generator *random, double probability);

enum { LAWS = 5, WAYS = 8, LONGEST_TEXT = 1 << 16, MOST_ENTRIES = 160, MOST_STEPS = 8, PROFILE_POINTS = 61 };
extern const char *const law_names[LAWS];
/* Algorithms and solvers, each a way to the solution. */
extern const char *const way_names[WAYS];

typedef enum { A_TEXT, A_REAL, A_LIST, AN_INTEGER, A_LOGICAL } entry_kind;

/* One key with its value, as a text has it and a call takes it. */
typedef struct {
  const char *group;
  int number;
  const char *key;
  entry_kind kind;
  char text[24];
  double value;
  const double *list;
} entry;

typedef struct {
  entry entries[MOST_ENTRIES];
  int count;
  int law, way;
  double limit; /* what the certificate must not be beyond */
  int steps;    /* &step groups */
  double modulus, force, half_width, approach, shift, mu, radius;
  mfv_step leads[MOST_STEPS]; /* further steps, for mfv_advance; absolute */
  int lead_count;
  double *coefficients; /* one a node; or NULL */
  int nodes, mesh_stays;
  int has_profile;
  double profile_x[PROFILE_POINTS], profile_height[PROFILE_POINTS];
  int free_states; /* kept states can be gone to in any order */
} random_case;

random_case *new_random_case(generator *random);
void free_random_case(random_case *self);

/* The namelist text; `text` has room for LONGEST_TEXT. */
void text_of_case(const random_case *self, char *text);

/* The scene by calls. Returns the first status that is not MFV_COMPLETE. */
int scene_of_case(const random_case *self, mfv_scene **scene);

#endif
