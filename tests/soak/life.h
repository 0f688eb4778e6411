/* What is done with one random case, and what came out. */
#ifndef LIFE_H
#define LIFE_H

#include "random_case.h"
#include <stdio.h>

enum { WHY = 300 };

typedef struct {
  int status; /* outcome of the last lead, or of what made the case */
  int law, way;
  int was_bad;        /* the text was spoilt on purpose */
  int was_told;       /* it ended early, saying that its certificate had grown */
  double certificate; /* NaN where there is none */
  uint64_t digits;    /* a checksum of everything that came out */
  char why[WHY];      /* what is wrong; empty where nothing is */
} life;

/* Live through case `number`. `folder`: for result files. `diary`: where the text and what was done with it are written; or NULL. */
life live(uint64_t seed, uint64_t number, const char *folder, FILE *diary);

#endif
