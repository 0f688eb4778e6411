/* Kind of file at a path. In C because the layout of struct stat depends on the system. */
#define _XOPEN_SOURCE 700
#include <sys/stat.h>

/* 0: a regular file; 1: a directory; 2: something else, such as a pipe or a device; 3: unknown, because it does not exist or a
   directory of the path cannot be searched. */
int mfv_file_kind(const char *path) {
  struct stat found;
  if (stat(path, &found) != 0) return 3;
  if (S_ISREG(found.st_mode)) return 0;
  return S_ISDIR(found.st_mode) ? 1 : 2;
}
