/* The standard streams, signals and threads of a program. In C because open flags and signal numbers depend on the system. */
#define _DEFAULT_SOURCE /* signal installs a handler for good */
#ifndef __ELF__
#include <dlfcn.h>
#endif
#include <errno.h>
#include <fcntl.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif
#include <signal.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

/* Call this first. A standard stream that the caller has closed is opened on /dev/null; otherwise the next file, such as a result,
   would get its number and receive the summary. Printing then fails, and messages are lost. A file-size limit becomes an error of
   the writing call instead of a signal. */
void mfv_begin_streams(void) {
  int descriptor;
  for (descriptor = STDIN_FILENO; descriptor <= STDERR_FILENO; descriptor++)
    if (fcntl(descriptor, F_GETFD) < 0 && errno == EBADF) open("/dev/null", descriptor == STDERR_FILENO ? O_WRONLY : O_RDONLY);
  signal(SIGXFSZ, SIG_IGN);
}

#ifdef __ELF__
void *blas_memory_alloc(int position) __attribute__((weak));
void blas_memory_free(void *memory) __attribute__((weak));
#endif

/* Write why the limits of the process are too small into `message` of the size `size`, and return 1; 0 if they suffice. With less memory
   OpenBLAS waits for it forever, and with a smaller stack the program would crash. Afterwards OpenBLAS has its memory, before the
   mesh takes the rest. */
int mfv_find_small_limit(char *message, int size) {
  static const struct {
    int resource;
    rlim_t least; /* bytes */
    const char *name, *option;
  } limits[] = {{RLIMIT_STACK, (rlim_t)1 << 20, "stack size", "-s"},
                {RLIMIT_AS, (rlim_t)1 << 28, "virtual memory", "-v"},
                {RLIMIT_DATA, (rlim_t)1 << 28, "data segment", "-d"}};
  struct rlimit limit;
  size_t i;
  for (i = 0; i < sizeof limits / sizeof *limits; i++) {
    if (getrlimit(limits[i].resource, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY || limit.rlim_cur >= limits[i].least) continue;
    snprintf(message, (size_t)size, "the limit of the %s (ulimit %s) is %lu kB; at least %lu kB are needed: raise it", limits[i].name,
             limits[i].option, (unsigned long)(limit.rlim_cur >> 10), (unsigned long)(limits[i].least >> 10));
    return 1;
  }
#ifdef __ELF__
  if (blas_memory_alloc != NULL && blas_memory_free != NULL) blas_memory_free(blas_memory_alloc(0));
#endif
  return 0;
}

/* One thread for OpenBLAS: a second one slows small systems down and changes the last digits of sums. The programs set this
   whatever OPENBLAS_NUM_THREADS says; the library leaves it to its host. No effect with another BLAS. */
#ifdef __ELF__
void openblas_set_num_threads(int count) __attribute__((weak));
void mfv_use_one_thread(void) {
  if (openblas_set_num_threads != NULL) openblas_set_num_threads(1);
}
#else
void mfv_use_one_thread(void) {
  void (*set)(int) = (void (*)(int))dlsym(dlopen(NULL, RTLD_LAZY), "openblas_set_num_threads");
  if (set != NULL) set(1);
}
#endif

#ifdef __ELF__
static int memory_is_limited(void) {
  struct rlimit addresses, data;
  return getrlimit(RLIMIT_AS, &addresses) != 0 || addresses.rlim_cur != RLIM_INFINITY || getrlimit(RLIMIT_DATA, &data) != 0 ||
         data.rlim_cur != RLIM_INFINITY;
}

#if defined(__GLIBC__) && defined(__LP64__) && defined(MADV_HUGEPAGE)
/* Keep freed memory, and let the first of it lie in large pages: arrays along the nodes come and go, and new pages cost more than the
   arithmetic on them. Only addresses are reserved; not where these are limited. */
static void keep_memory(void) {
  enum { large_page = 1 << 21, reserve = 1 << 26, most_on_heap = 1 << 25, keep = 1 << 30, pad = 1 << 20, beginning = 1 << 18 };
  static char *volatile kept[2]; /* what lies before the first large page: neither used nor freed */
  size_t size;
  if (memory_is_limited()) return;
  mallopt(M_MMAP_THRESHOLD, most_on_heap);
  mallopt(M_TRIM_THRESHOLD, keep);
  mallopt(M_TOP_PAD, reserve);
  kept[0] = malloc(beginning); /* more than the heap has, and in none of the large pages */
  mallopt(M_TOP_PAD, pad);
  if (kept[0] == NULL) return;
  size = large_page - (uintptr_t)(kept[0] + beginning) % large_page;
  madvise(kept[0] + beginning + size, reserve - large_page, MADV_HUGEPAGE);
  kept[1] = malloc(size);
}
#else
static void keep_memory(void) {}
#endif

#ifdef MFV_STATIC_HDF5
int H5dont_atexit(void);
#endif

/* OpenBLAS that is linked dynamically has started its threads before; each takes memory, and waits forever for what a limit denies
   it. Begin again with one thread. */
static void limit_threads(char **arguments) {
  const char *threads = getenv("OPENBLAS_NUM_THREADS");
  if (threads != NULL && strcmp(threads, "1") == 0) return;
  setenv("OPENBLAS_NUM_THREADS", "1", 1);
#ifdef __GLIBC__ /* it gives constructors the arguments */
  if (memory_is_limited()) execv("/proc/self/exe", arguments);
#else
  (void)arguments;
#endif
}

/* Before main, because OpenBLAS that is linked statically starts its threads, which spin for some milliseconds, there. HDF5 need not
   tidy up at the end: files are closed where they are written. */
__attribute__((constructor(101))) static void start_process(int count, char **arguments) {
  (void)count;
  limit_threads(arguments);
  keep_memory();
#ifdef MFV_STATIC_HDF5
  H5dont_atexit();
#endif
}
#endif

static volatile sig_atomic_t interrupted, saves, exit_code;

/* Without a result to save the program ends at once, as it does after a second signal. */
static void handle_signal(int number) {
  static const char message[] = "interrupted before the first increment; no result is written\n";
  if (!saves) {
    if (write(STDERR_FILENO, message, sizeof message - 1) < 0) _exit(exit_code);
    _exit(exit_code);
  }
  interrupted = number;
  signal(number, SIG_DFL);
}

/* Have Ctrl-C and termination requests end the program: with the exit code `code` until there is a result to save, then at the next
   increment of the run, with its result written. */
void mfv_catch_interrupts(int code) {
  exit_code = code;
  signal(SIGINT, handle_signal);
  signal(SIGTERM, handle_signal);
}

/* From now on there is a result to save. */
void mfv_begin_saving(void) { saves = 1; }

/* Whether the program has been asked to end. */
int mfv_is_interrupted(void) { return interrupted != 0; }
