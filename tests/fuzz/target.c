/* What is fuzzed, as one program. It takes commands from standard input, one a line: the name of a target and the path of
 * a file; does with the file what a program of MFV would; and answers with one line: status, seconds, largest residual of the
 * certificate (-1: nothing was solved), first line of the message. "leaks" answers the number of leaks since the last time
 * (0 or 1; -1: built without a leak detector). The word "fuzz_target" is written first, so that nobody waits for what cannot start.
 *
 * target FILE (arguments, not commands): the same once, for AFL++. */
#include <mfv.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* fuzz_readers.f90 */
int fuzz_matrix(const char *path, char *message, size_t size);
int fuzz_stress(const char *path, char *message, size_t size);
int fuzz_columns(const char *path, char *message, size_t size);

int fuzz_open_objects(void);

/* Of the sanitizers, where they are linked in. */
int __lsan_do_recoverable_leak_check(void) __attribute__((weak));

enum { LONGEST = 4096, MOST_INCREMENTS = 300 };
static const double most_seconds = 1.0;

typedef struct outcome {
  int status;
  double residual;
  char message[LONGEST];
} outcome;

static double seconds(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

typedef struct patience {
  int increments;
  double started;
} patience;

/* An observer that ends what is legitimately long. */
static int watch(const mfv_progress *progress, void *user) {
  patience *so_far = user;
  (void)progress;
  so_far->increments++;
  return so_far->increments > MOST_INCREMENTS || seconds() - so_far->started > most_seconds;
}

static void fail(const char *what) {
  printf("fuzz_target: %s\n", what);
  fflush(stdout);
  abort();
}

/* Copy out every field and attribute of a case. */
static void ask_for_everything(const mfv_case *handle) {
  size_t count, i;
  char path[256], name[256];
  if (mfv_field_count(handle, &count) != MFV_COMPLETE) fail("no fields");
  for (i = 0; i < count; i++) {
    size_t values;
    int is_integer, status;
    if (mfv_field_path(handle, i, path, sizeof path) != MFV_COMPLETE) fail("a field without a path");
    if (mfv_field_info(handle, path, &values, &is_integer, NULL, NULL, 0, NULL, 0) != MFV_COMPLETE) fail(path);
    if (is_integer) {
      int32_t *copy = malloc(values * sizeof *copy + 1);
      status = mfv_copy_integer(handle, path, copy, values);
      free(copy);
    } else {
      double *copy = malloc(values * sizeof *copy + 1);
      status = mfv_copy_real(handle, path, copy, values);
      free(copy);
    }
    if (status != MFV_COMPLETE) fail(path);
  }
  for (i = 0; mfv_attribute_name(handle, i, name, sizeof name) == MFV_COMPLETE; i++) {
    size_t length;
    if (mfv_attribute(handle, name, NULL, 0, &length) != MFV_COMPLETE) fail(name);
  }
}

/* A case: read, and where it can be solved solved. */
static void solve(const char *path, outcome *answer) {
  mfv_case *handle = NULL;
  patience so_far = {0, seconds()};
  answer->status = mfv_create_from_file(path, &handle, answer->message, sizeof answer->message);
  if ((answer->status == MFV_COMPLETE) != (handle != NULL)) fail("a status that does not fit the handle");
  if (handle == NULL) {
    if (answer->message[0] == '\0') fail("a failure without a message");
    return;
  }
  if (mfv_observe(handle, watch, &so_far) != MFV_COMPLETE) fail("no observer");
  answer->status = mfv_run(handle);
  if (mfv_copy_real(handle, "summary/largest_residual", &answer->residual, 1) != MFV_COMPLETE) fail("no certificate");
  if (answer->status != MFV_COMPLETE) mfv_message(handle, answer->message, sizeof answer->message);
  ask_for_everything(handle);
  if (mfv_free(&handle) != MFV_COMPLETE) fail("mfv_free");
}

static void run(const char *target, const char *path, outcome *answer) {
  static const struct {
    const char *name;
    int (*read)(const char *, char *, size_t);
  } readers[] = {{"matrix", fuzz_matrix}, {"stress", fuzz_stress}, {"columns", fuzz_columns}};
  static int open_objects = 0;
  size_t i;
  answer->residual = -1.0;
  answer->message[0] = '\0';
  if (strcmp(target, "case") == 0) {
    solve(path, answer);
    return;
  }
  for (i = 0; i < sizeof readers / sizeof readers[0]; i++) {
    if (strcmp(target, readers[i].name) == 0) {
      answer->status = readers[i].read(path, answer->message, sizeof answer->message);
      /* The first time HDF5 makes objects of its own, which stay. */
      if (open_objects > 0 && fuzz_open_objects() > open_objects) fail("objects of HDF5 are left open");
      open_objects = fuzz_open_objects();
      return;
    }
  }
  fail("unknown target");
}

int main(int argc, char **argv) {
  static char line[LONGEST];
  static outcome answer;
  if (argc == 3) {
    run(argv[1], argv[2], &answer);
    return 0;
  }
  puts("fuzz_target");
  fflush(stdout);
  while (fgets(line, sizeof line, stdin) != NULL) {
    char *path;
    double started = seconds();
    line[strcspn(line, "\n")] = '\0';
    if (strcmp(line, "leaks") == 0) {
      printf("%d\n", __lsan_do_recoverable_leak_check ? __lsan_do_recoverable_leak_check() : -1);
      fflush(stdout);
      continue;
    }
    path = strchr(line, ' ');
    if (path == NULL) fail("a command is TARGET PATH");
    *path++ = '\0';
    run(line, path, &answer);
    answer.message[strcspn(answer.message, "\n")] = '\0';
    printf("%d\t%.3f\t%.3e\t%s\n", answer.status, seconds() - started, answer.residual, answer.message);
    fflush(stdout);
  }
  return 0;
}
