/* To be preloaded into a program under test: counts and writes down what it does to the files of one folder, and makes one of
   these calls fail, or kills the process there. Settings, by the environment:

   MFV_FAULT_FOLDER   only calls on files in this folder count
   MFV_FAULT_LOG      file for one line a call: "write /folder/name", "rename /folder/name /folder/other"; not in the folder
   MFV_FAULT_AT       number of the call that fails, from 1; none where it is not there
   MFV_FAULT_ERRNO    with this errno; 0: the process is killed in place of the call (SIGKILL)
   MFV_FAULT_STAYS    set: every later call that needs space on the disk fails too

   Calls that count: making a file (open), write, fsync, ftruncate, close of a file that was made or opened to be written,
   rename. unlink is written down and never fails. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <pthread.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { MOST_DESCRIPTORS = 1024 };

static pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
static int calls = 0;
/* Names of the files of the folder that are open, by descriptor; and whether the descriptor is one to write by. */
static char names[MOST_DESCRIPTORS][PATH_MAX];
static char writes[MOST_DESCRIPTORS];

static long setting(const char *name, long otherwise) {
  const char *text = getenv(name);
  return text == NULL ? otherwise : strtol(text, NULL, 10);
}

static int (*real_open(void))(const char *, int, ...) {
  return (int (*)(const char *, int, ...))dlsym(RTLD_NEXT, "open");
}

static ssize_t real_write(int descriptor, const void *bytes, size_t count) {
  ssize_t (*next)(int, const void *, size_t) = (ssize_t(*)(int, const void *, size_t))dlsym(RTLD_NEXT, "write");
  return next(descriptor, bytes, count);
}

static int real_close(int descriptor) {
  int (*next)(int) = (int (*)(int))dlsym(RTLD_NEXT, "close");
  return next(descriptor);
}

/* The path with its folder in full, into `whole`; whether it is in the folder that counts (or is that folder). */
static int in_folder(const char *path, char *whole) {
  const char *folder = getenv("MFV_FAULT_FOLDER");
  char copy[PATH_MAX], real[PATH_MAX];
  char *slash;
  if (folder == NULL || strlen(path) >= PATH_MAX / 2) return 0;
  strcpy(copy, path);
  slash = strrchr(copy, '/');
  if (slash != NULL) *slash = '\0';
  if (realpath(slash == NULL ? "." : slash == copy ? "/" : copy, real) == NULL) return 0;
  snprintf(whole, PATH_MAX, "%.2000s/%.2000s", real, slash == NULL ? path : slash + 1);
  if (realpath(whole, real) != NULL && strcmp(real, folder) == 0) {
    strcpy(whole, real);
    return 1;
  }
  return strncmp(whole, folder, strlen(folder)) == 0 && whole[strlen(folder)] == '/';
}

static void write_down(const char *kind, const char *name, const char *other) {
  const char *log = getenv("MFV_FAULT_LOG");
  char line[2 * PATH_MAX + 32];
  int descriptor, length;
  if (log == NULL) return;
  descriptor = real_open()(log, O_WRONLY | O_CREAT | O_APPEND, 0666);
  if (descriptor < 0) return;
  length = snprintf(line, sizeof line, "%s %s%s%s\n", kind, name, other[0] == '\0' ? "" : " ", other);
  if (real_write(descriptor, line, (size_t)length) != length) abort();
  real_close(descriptor);
}

/* Write a call down; whether it is to fail, with errno set. */
static int fails(const char *kind, const char *name, const char *other, int needs_space) {
  long at = setting("MFV_FAULT_AT", 0), number = setting("MFV_FAULT_ERRNO", ENOSPC);
  int is_it, before = errno;
  pthread_mutex_lock(&mutex);
  calls++;
  is_it = calls == at || (at > 0 && calls > at && needs_space && getenv("MFV_FAULT_STAYS") != NULL);
  write_down(kind, name, other);
  pthread_mutex_unlock(&mutex);
  errno = before;
  if (!is_it) return 0;
  if (number == 0) kill(getpid(), SIGKILL);
  errno = (int)number;
  return 1;
}

static int tracked(int descriptor) { return descriptor >= 0 && descriptor < MOST_DESCRIPTORS && names[descriptor][0] != '\0'; }

static int open_any(const char *path, int flags, mode_t mode) {
  char whole[PATH_MAX];
  int descriptor, inside = in_folder(path, whole), is_to_write = (flags & O_ACCMODE) != O_RDONLY;
  if (inside && (flags & O_CREAT) && fails("open", whole, "", 1)) return -1;
  descriptor = real_open()(path, flags, mode);
  if (descriptor >= 0 && descriptor < MOST_DESCRIPTORS && inside) {
    strcpy(names[descriptor], whole);
    writes[descriptor] = (char)is_to_write;
  }
  return descriptor;
}

int open(const char *path, int flags, ...) {
  va_list arguments;
  mode_t mode = 0;
  va_start(arguments, flags);
  if (flags & O_CREAT) mode = va_arg(arguments, mode_t);
  va_end(arguments);
  return open_any(path, flags, mode);
}

int open64(const char *path, int flags, ...) {
  va_list arguments;
  mode_t mode = 0;
  va_start(arguments, flags);
  if (flags & O_CREAT) mode = va_arg(arguments, mode_t);
  va_end(arguments);
  return open_any(path, flags, mode);
}

ssize_t write(int descriptor, const void *bytes, size_t count) {
  if (tracked(descriptor) && fails("write", names[descriptor], "", 1)) return -1;
  return real_write(descriptor, bytes, count);
}

ssize_t pwrite64(int descriptor, const void *bytes, size_t count, off64_t at) {
  ssize_t (*next)(int, const void *, size_t, off64_t) =
      (ssize_t(*)(int, const void *, size_t, off64_t))dlsym(RTLD_NEXT, "pwrite64");
  if (tracked(descriptor) && fails("write", names[descriptor], "", 1)) return -1;
  return next(descriptor, bytes, count, at);
}

ssize_t pwrite(int descriptor, const void *bytes, size_t count, off_t at) { return pwrite64(descriptor, bytes, count, at); }

int ftruncate64(int descriptor, off64_t length) {
  int (*next)(int, off64_t) = (int (*)(int, off64_t))dlsym(RTLD_NEXT, "ftruncate64");
  if (tracked(descriptor) && fails("ftruncate", names[descriptor], "", 0)) return -1;
  return next(descriptor, length);
}

int ftruncate(int descriptor, off_t length) { return ftruncate64(descriptor, length); }

int fsync(int descriptor) {
  int (*next)(int) = (int (*)(int))dlsym(RTLD_NEXT, "fsync");
  if (tracked(descriptor) && fails("fsync", names[descriptor], "", 0)) return -1;
  return next(descriptor);
}

/* As the system does it, a close that fails closes nevertheless. */
int close(int descriptor) {
  int failed = 0, code, number = 0;
  if (tracked(descriptor)) {
    failed = writes[descriptor] && fails("close", names[descriptor], "", 0);
    number = errno;
    names[descriptor][0] = '\0';
  }
  code = real_close(descriptor);
  if (!failed) return code;
  errno = number;
  return -1;
}

int remove(const char *path) {
  int (*next)(const char *) = (int (*)(const char *))dlsym(RTLD_NEXT, "remove");
  char whole[PATH_MAX];
  if (in_folder(path, whole)) write_down("unlink", whole, "");
  return next(path);
}

int rename(const char *from, const char *to) {
  int (*next)(const char *, const char *) = (int (*)(const char *, const char *))dlsym(RTLD_NEXT, "rename");
  char whole[PATH_MAX], other[PATH_MAX];
  if (in_folder(from, whole) && in_folder(to, other) && fails("rename", whole, other, 0)) return -1;
  return next(from, to);
}

int unlink(const char *path) {
  int (*next)(const char *) = (int (*)(const char *))dlsym(RTLD_NEXT, "unlink");
  char whole[PATH_MAX];
  if (in_folder(path, whole)) write_down("unlink", whole, "");
  return next(path);
}
