/* To be preloaded into a program under test: makes one call on the file that is to replace another, NAME.part<process>, fail, or
   kills the process there. Settings, by the environment:

   MFV_FAULT_CALL   write, fsync, rename, or folder (the fsync after the rename)
   MFV_FAULT_ERRNO  with this errno; 0: the process is killed in place of the call (SIGKILL) */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <limits.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Whether a call is to fail, with errno set. */
static int fails(const char *call) {
  const char *wanted = getenv("MFV_FAULT_CALL"), *number = getenv("MFV_FAULT_ERRNO");
  if (wanted == NULL || number == NULL || strcmp(call, wanted) != 0) return 0;
  errno = atoi(number);
  if (errno == 0) kill(getpid(), SIGKILL);
  return 1;
}

/* Whether an open file is one that is to replace another. */
static int is_part(int descriptor) {
  char link[64], name[PATH_MAX];
  ssize_t length;
  snprintf(link, sizeof link, "/proc/self/fd/%d", descriptor);
  length = readlink(link, name, sizeof name - 1);
  name[length < 0 ? 0 : length] = '\0';
  return strstr(name, ".part") != NULL;
}

ssize_t write(int descriptor, const void *bytes, size_t count) {
  ssize_t (*next)(int, const void *, size_t) = (ssize_t(*)(int, const void *, size_t))dlsym(RTLD_NEXT, "write");
  return is_part(descriptor) && fails("write") ? -1 : next(descriptor, bytes, count);
}

int fsync(int descriptor) {
  int (*next)(int) = (int (*)(int))dlsym(RTLD_NEXT, "fsync");
  return fails(is_part(descriptor) ? "fsync" : "folder") ? -1 : next(descriptor);
}

int rename(const char *from, const char *to) {
  int (*next)(const char *, const char *) = (int (*)(const char *, const char *))dlsym(RTLD_NEXT, "rename");
  return fails("rename") ? -1 : next(from, to);
}
