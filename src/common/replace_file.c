/* Atomic replacement of a file: a new file is written beside it, flushed to disk and renamed. In C because open flags, file modes
   and errno depend on the system. */
#define _XOPEN_SOURCE 700
#include <errno.h>
#include <fcntl.h>
#include <libgen.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* Instead of an errno: the existing file is a device, a pipe or the like. */
enum { NOT_REGULAR = -1 };

/* Write all bytes to an open file. Returns 0 or an errno. */
int mfv_write_all(int descriptor, const char *bytes, size_t count) {
  /* Some systems write no more at once. */
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

/* Create an empty file beside `target` with the name `part`, and the mode and, if permitted, the owner of `target`. `target` must not
   exist or be a writable regular file. Returns 0 or an errno. */
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

/* Flush a file or a folder to disk. No failure on file systems without support. */
static int sync_open(int descriptor) {
  if (fsync(descriptor) == 0 || errno == EINVAL || errno == ENOTSUP || errno == ENOSYS) return 0;
  return errno;
}

/* Flush the folder of `path`; `path` is modified. No failure for a folder without read permission. */
static int sync_folder(char *path) {
  int code, descriptor = open(dirname(path), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return 0;
  code = sync_open(descriptor);
  close(descriptor);
  return code;
}

/* Replace the file at `path` (the target of a symbolic link) by `bytes`; without bytes (null) only create and remove the new file.
   Returns 0 or an errno: then the old file is unchanged or, with `is_in_place`, replaced by the new one, which may be lost in a
   power cut. */
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

/* Description of such a code. */
void mfv_describe_error(int code, char *text, size_t length) {
  if (code == NOT_REGULAR)
    snprintf(text, length, "it is not a regular file");
  else if (strerror_r(code, text, length) != 0) snprintf(text, length, "error %d", code);
}
