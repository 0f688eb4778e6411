/* Random cases through the C interface in one process, for a time or a number of cases. Memory must stay flat, no certificate may be
 * beyond what the library promises, and a case that is lived through again must give the same digits.
 *
 *   soak [--seconds S | --cases N] [--threads T] [--seed S] [--record FILE] [--folder DIR] | --seed S --case K
 *
 * --cases: run these twice; the second time nothing new can enter a cache. --record: a line for every round: seconds, cases, bytes
 * in use, bytes resident. --folder: for result files and the texts of cases that failed (soak-SEED-NUMBER.nml).
 * --case: only this case. Exit code 0 without failures. */
#define _GNU_SOURCE
#include "life.h"
#include <dlfcn.h>
#include <math.h>
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>
#if defined(__GLIBC__) && (__GLIBC__ > 2 || __GLIBC_MINOR__ >= 33)
#include <malloc.h>
#define BYTES_IN_USE() (mallinfo2().uordblks + mallinfo2().hblkhd)
#else
#define BYTES_IN_USE() 0
#endif

enum { MOST_THREADS = 64, MOST_ROUNDS = 4000, ROUNDS = 200 };

/* What one thread has seen. */
typedef struct {
  long cases, failures, told, repeated;
  long outcomes[MFV_STATUS_COUNT];
  long of_way[WAYS][LAWS];
  double worst[WAYS][LAWS];
} tally;

static struct {
  double seconds;
  long cases, one_case;
  int threads;
  uint64_t seed;
  const char *record, *folder;
} options = {0, 0, 0, 1, 1, NULL, "."};

static struct {
  double seconds;
  long cases;
  double in_use, resident;
} samples[MOST_ROUNDS];

static double round_ends;
static long round_cases;
static volatile sig_atomic_t interrupted;
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static long next_case = 1;

static void interrupt(int number) { interrupted = number; }

static double now(void) {
  struct timespec time;
  clock_gettime(CLOCK_MONOTONIC, &time);
  return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

static double resident(void) {
  long pages = 0, size = 0;
  FILE *file = fopen("/proc/self/statm", "r");
  if (file == NULL) return 0;
  if (fscanf(file, "%ld %ld", &size, &pages) != 2) pages = 0;
  fclose(file);
  return (double)pages * (double)sysconf(_SC_PAGESIZE);
}

/* The text of a case that failed goes to a file, with what was done with it. */
static void report(long number, const life *out) {
  char path[400];
  snprintf(path, sizeof path, "%s/soak-%llu-%ld.nml", options.folder, (unsigned long long)options.seed, number);
  FILE *file = fopen(path, "w");
  if (file != NULL) {
    fprintf(file, "! soak --seed %llu --case %ld: %s\n", (unsigned long long)options.seed, number, out->why);
    live(options.seed, (uint64_t)number, options.folder, file);
    fclose(file);
  }
  printf("case %ld (%s, %s): %s; see %s\n", number, way_names[out->way], law_names[out->law], out->why, path);
  fflush(stdout);
}

/* Live through a case, now and then twice, and count. */
static void one(long number, tally *seen) {
  life out = live(options.seed, (uint64_t)number, options.folder, NULL);
  if (number % 16 == 0) {
    life again = live(options.seed, (uint64_t)number, options.folder, NULL);
    ++seen->repeated;
    if (again.digits != out.digits && out.why[0] == '\0') snprintf(out.why, sizeof out.why, "lived through again it gives other digits");
  }
  ++seen->cases;
  if (out.why[0] != '\0') {
    ++seen->failures;
    pthread_mutex_lock(&lock);
    report(number, &out);
    pthread_mutex_unlock(&lock);
  }
  ++seen->outcomes[out.status];
  seen->told += out.was_told;
  if (isnan(out.certificate) || out.was_bad || out.was_told) return;
  ++seen->of_way[out.way][out.law];
  if (out.certificate > seen->worst[out.way][out.law]) seen->worst[out.way][out.law] = out.certificate;
}

static void *work(void *argument) {
  for (;;) {
    pthread_mutex_lock(&lock);
    int goes_on = !interrupted && (options.cases > 0 ? round_cases-- > 0 : now() < round_ends);
    long number = goes_on ? next_case++ : 0;
    pthread_mutex_unlock(&lock);
    if (!goes_on) return NULL;
    one(number, argument);
  }
}

static void add(tally *sum, const tally *part) {
  sum->cases += part->cases;
  sum->failures += part->failures;
  sum->told += part->told;
  sum->repeated += part->repeated;
  for (int i = 0; i < MFV_STATUS_COUNT; ++i) sum->outcomes[i] += part->outcomes[i];
  for (int way = 0; way < WAYS; ++way)
    for (int law = 0; law < LAWS; ++law) {
      sum->of_way[way][law] += part->of_way[way][law];
      sum->worst[way][law] = fmax(sum->worst[way][law], part->worst[way][law]);
    }
}

/* One round in all threads; afterwards nothing of the library is alive. */
static void go_round(tally *sum) {
  pthread_t threads[MOST_THREADS];
  static tally seen[MOST_THREADS];
  memset(seen, 0, sizeof seen);
  for (int i = 1; i < options.threads; ++i)
    if (pthread_create(&threads[i], NULL, work, &seen[i]) != 0) abort();
  work(&seen[0]);
  for (int i = 1; i < options.threads; ++i) pthread_join(threads[i], NULL);
  for (int i = 0; i < options.threads; ++i) add(sum, &seen[i]);
}

static void print_tally(const tally *sum) {
  char outcome[100], explanation[300];
  printf("cases %ld, lived through again %ld, failures %ld\n", sum->cases, sum->repeated, sum->failures);
  for (int status = 0; status < MFV_STATUS_COUNT; ++status) {
    mfv_status_text(status, outcome, sizeof outcome, explanation, sizeof explanation);
    if (sum->outcomes[status] > 0) printf("  %-28s %ld\n", outcome, sum->outcomes[status]);
  }
  printf("ended early because the certificate had grown, not below: %ld\n", sum->told);
  printf("worst certificate (number of cases):\n  %-14s", "");
  for (int law = 0; law < LAWS; ++law) printf("%-20s", law_names[law]);
  for (int way = 0; way < WAYS; ++way) {
    printf("\n  %-14s", way_names[way]);
    for (int law = 0; law < LAWS; ++law)
      if (sum->of_way[way][law] > 0) printf("%-8.1e (%-8ld) ", sum->worst[way][law], sum->of_way[way][law]);
      else printf("%-20s", "-");
  }
  printf("\n");
}

static double mean(int from, int to, int of_resident) {
  double sum = 0;
  for (int i = from; i < to; ++i) sum += of_resident ? samples[i].resident : samples[i].in_use;
  return sum / (to - from);
}

/* Whether memory stayed flat in the second half: its second half against its first one. Between rounds nothing is alive, so what
 * is in use is the library's cache of transforms and the table of handles alone. */
static int is_flat(int rounds) {
  int half = rounds / 2, last = half + (rounds - half) / 2;
  if (rounds < 8) return 1;
  double in_use = mean(half, last, 0), in_use_then = mean(last, rounds, 0);
  double held = mean(half, last, 1), held_then = mean(last, rounds, 1);
  printf("memory in use between cases: %.0f kB, then %.0f kB; resident: %.0f kB, then %.0f kB\n", in_use / 1024, in_use_then / 1024,
         held / 1024, held_then / 1024);
#ifdef __SANITIZE_ADDRESS__
  return 1; /* the address sanitizer holds back what is freed */
#endif
  return in_use_then - in_use <= 0.02 * in_use + 65536 && held_then - held <= 0.02 * held + 1048576;
}

static void sample(int i, double seconds, long cases, FILE *record) {
  samples[i].seconds = seconds;
  samples[i].cases = cases;
  samples[i].in_use = (double)BYTES_IN_USE();
  samples[i].resident = resident();
  if (record != NULL) fprintf(record, "%.1f %ld %.0f %.0f\n", seconds, cases, samples[i].in_use, samples[i].resident);
  if (record != NULL) fflush(record);
  if (isatty(STDERR_FILENO)) fprintf(stderr, "\r%.0f s, %ld cases, %.1f MB resident ", seconds, cases, samples[i].resident / 1e6);
}

static int soak(void) {
  static tally sum;
  const double start = now(), part = options.seconds / ROUNDS;
  const int rounds = options.cases > 0 ? 16 : ROUNDS;
  FILE *record = options.record != NULL ? fopen(options.record, "w") : NULL;
  int done = 0;
  if (options.record != NULL && record == NULL) {
    perror(options.record);
    return 0;
  }
  for (; done < rounds && !interrupted; ++done) {
    round_ends = start + (done + 1) * part;
    round_cases = 2 * options.cases / rounds;
    if (options.cases > 0 && 2 * done == rounds) next_case = 1;
    go_round(&sum);
    sample(done, now() - start, sum.cases, record);
  }
  if (isatty(STDERR_FILENO)) fprintf(stderr, "\n");
  if (record != NULL) fclose(record);
  print_tally(&sum);
  const int flat = is_flat(done);
  printf("%ld cases in %.0f s, %ld failed, memory %s (seed %llu)\n", sum.cases, now() - start, sum.failures, flat ? "flat" : "grows",
         (unsigned long long)options.seed);
  return flat && sum.failures == 0 && sum.cases > 0;
}

static int read_options(int count, char **words) {
  for (int i = 1; i + 1 < count; i += 2) {
    const char *value = words[i + 1];
    if (strcmp(words[i], "--seconds") == 0) options.seconds = atof(value);
    else if (strcmp(words[i], "--cases") == 0) options.cases = atol(value);
    else if (strcmp(words[i], "--threads") == 0) options.threads = atoi(value);
    else if (strcmp(words[i], "--seed") == 0) options.seed = strtoull(value, NULL, 10);
    else if (strcmp(words[i], "--record") == 0) options.record = value;
    else if (strcmp(words[i], "--folder") == 0) options.folder = value;
    else if (strcmp(words[i], "--case") == 0) options.one_case = atol(value);
    else return 0;
  }
  return count % 2 == 1 && options.threads > 0 && options.threads <= MOST_THREADS &&
         (options.seconds > 0) + (options.cases > 0) + (options.one_case > 0) == 1;
}

/* The systems are small: a second thread of OpenBLAS costs more than it does (drivers/process.c). */
static void use_one_thread_in_blas(void) {
  void (*set)(int) = (void (*)(int))dlsym(RTLD_DEFAULT, "openblas_set_num_threads");
  if (set != NULL) set(1);
}

int main(int count, char **words) {
  if (!read_options(count, words)) {
    fprintf(stderr, "usage: soak [--seconds S | --cases N] [--threads T] [--seed S] [--record FILE] [--folder DIR] | --seed S --case K\n");
    return 2;
  }
  signal(SIGINT, interrupt);
  signal(SIGTERM, interrupt);
  use_one_thread_in_blas();
  if (options.one_case == 0) return soak() ? 0 : 1;
  life out = live(options.seed, (uint64_t)options.one_case, options.folder, stdout);
  printf("%s, %s: outcome %d, certificate %g\n", way_names[out.way], law_names[out.law], out.status, out.certificate);
  return out.why[0] != '\0';
}
