/* Locking a file without waiting. In C because errno is a macro, and its numbers are the system's own. */
#define _XOPEN_SOURCE 700
#include <errno.h>
#include <unistd.h>

/* 0: the open file is locked for this process, until it is closed or the process ends; 1: another process has it; 2: it
   cannot be locked, because the file system does not know locks for one. */
int mfv_try_lock(int descriptor) {
  if (lockf(descriptor, F_TLOCK, 0) == 0) return 0;
  return errno == EAGAIN || errno == EACCES ? 1 : 2;
}
