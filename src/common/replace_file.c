/* Replacing a file as a whole: what is written beside it takes its place when it is on the disk. In C because open flags, file
   modes and errno are the system's own. */
#define _XOPEN_SOURCE 700
#include <errno.h>
#include <fcntl.h>
#include <libgen.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* In place of an errno: what is there is a device, a pipe or the like. */
enum { NOT_REGULAR = -1 };

/* Write bytes where the open file is, all of them: 0, or the errno of what failed. */
int mfv_write_all(int descriptor, const char *bytes, size_t count) {
  /* More at once is not written by every system. */
  const size_t most = 1 << 30;
  ssize_t done;
  while (count > 0) {
    done = write(descriptor, bytes, count < most ? count : most);
    if (done < 0 && errno == EINTR) continue;
    if (done < 0) return errno;
    bytes += done;
    count -= (size_t)done;
  }
  return 0;
}

/* Make an empty file beside `target` under the name `part`, with the mode of what is there, and as far as the system allows its
   owner. What is there must be nothing, or a regular file that may be written. 0, or what failed. */
static int make_part(const char *target, char *part, size_t length, int *descriptor) {
  struct stat old;
  int number = 0, is_there = stat(target, &old) == 0;
  if (!is_there && errno != ENOENT) return errno;
  if (is_there && S_ISDIR(old.st_mode)) return EISDIR;
  if (is_there && !S_ISREG(old.st_mode)) return NOT_REGULAR;
  if (is_there && access(target, W_OK) != 0) return errno;
  do {
    snprintf(part, length, "%s.part%ld-%d", target, (long)getpid(), number++);
    *descriptor = open(part, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  } while (*descriptor < 0 && errno == EEXIST);
  if (*descriptor < 0) return errno;
  if (!is_there || fchown(*descriptor, old.st_uid, old.st_gid) != 0) errno = 0;
  return is_there && fchmod(*descriptor, old.st_mode & 0777) != 0 ? errno : 0;
}

/* Have the disk take a file, or the entries of a folder. A file system that cannot is no failure. */
static int sync_open(int descriptor) {
  if (fsync(descriptor) == 0 || errno == EINVAL || errno == ENOTSUP || errno == ENOSYS) return 0;
  return errno;
}

/* Have the disk take the entry of `path`, which is then changed. A folder that may be written and not read is no failure. */
static int sync_folder(char *path) {
  int code, descriptor = open(dirname(path), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return 0;
  code = sync_open(descriptor);
  close(descriptor);
  return code;
}

/* Replace the file at `path` (that which it names, where it is a symbolic link) by `bytes`; without bytes (null) only make and
   remove the file that would take its place. 0, or what failed: then the old file is there, or, with `is_in_place`, the new one,
   whose entry in the folder a power cut could undo. */
int mfv_replace_file(const char *path, const char *bytes, size_t count, int *is_in_place) {
  char *target = realpath(path, NULL), *part;
  size_t length;
  int code, descriptor = -1;
  *is_in_place = 0;
  if (target == NULL && errno == ENOENT) target = strdup(path);
  if (target == NULL) return errno;
  length = strlen(target) + 48;
  part = malloc(length);
  code = part == NULL ? ENOMEM : make_part(target, part, length, &descriptor);
  if (code == 0 && bytes != NULL) code = mfv_write_all(descriptor, bytes, count);
  if (code == 0 && bytes != NULL) code = sync_open(descriptor);
  if (descriptor >= 0 && close(descriptor) != 0 && code == 0) code = errno;
  if (code == 0 && bytes != NULL) {
    *is_in_place = rename(part, target) == 0;
    code = *is_in_place ? sync_folder(target) : errno;
  }
  if (descriptor >= 0 && !*is_in_place) unlink(part);
  free(part);
  free(target);
  return code;
}

/* What such a code means, in words. */
void mfv_describe_error(int code, char *text, size_t length) {
  if (code == NOT_REGULAR)
    snprintf(text, length, "it is no regular file");
  else if (strerror_r(code, text, length) != 0) snprintf(text, length, "error %d", code);
}
