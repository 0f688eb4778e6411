/* CHECK prints what failed and where, and counts it. */
#ifndef MFV_TESTS_CHECK_H
#define MFV_TESTS_CHECK_H

#include <stdio.h>

static int failures = 0;

#define CHECK(condition)                                                  \
  do {                                                                    \
    if (!(condition)) {                                                   \
      printf("%s:%d: failed: %s\n", __FILE__, __LINE__, #condition);      \
      ++failures;                                                         \
    }                                                                     \
  } while (0)

#endif
