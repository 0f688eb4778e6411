/* A file that is written beside another and then takes its place, at once and for good. In C because open flags, file modes
   and errno are the system's own. Functions return 0, or the errno of what failed. */
#define _XOPEN_SOURCE 700
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

/* Links that are followed at most, as the system itself does. */
enum { MOST_LINKS = 40 };
/* Names that are tried for one file. */
enum { MOST_NAMES = 10000 };
/* Seconds after which the part of a process that is not on this machine, or no more, is taken for left behind. */
enum { STALE_AGE = 3600 };

/* In place of an errno: what is there is a device, a pipe or the like; what is there is no longer what was there. */
enum { NOT_REGULAR = -1, CHANGED = -2 };

static const char ending[] = ".part";

/* Length of the folder in a path, with its final slash. */
static size_t folder_length(const char *path) {
  const char *slash = strrchr(path, '/');
  return slash == NULL ? 0 : (size_t)(slash - path) + 1;
}

/* The folder of a path as a new string; null without memory. */
static char *folder_of(const char *path) {
  size_t length = folder_length(path);
  char *folder = malloc(length + 2);
  if (folder == NULL) return NULL;
  memcpy(folder, path, length);
  strcpy(folder + length, length == 0 ? "." : "");
  return folder;
}

/* What the symbolic link `path` names, seen from where `path` is seen from, as a new string; null where it cannot be told. */
static char *follow_link(const char *path) {
  char target[PATH_MAX];
  char *whole;
  size_t folder;
  ssize_t length = readlink(path, target, sizeof target - 1);
  if (length < 0) return NULL;
  target[length] = '\0';
  folder = target[0] == '/' ? 0 : folder_length(path);
  whole = malloc(folder + (size_t)length + 1);
  if (whole == NULL) {
    errno = ENOMEM;
    return NULL;
  }
  memcpy(whole, path, folder);
  strcpy(whole + folder, target);
  return whole;
}

/* The file behind `path`, with all symbolic links of its last name followed, as a new string: it need not be there. */
static char *resolve(const char *path) {
  struct stat found;
  int links;
  char *next, *resolved = strdup(path);
  for (links = 0; resolved != NULL; links++) {
    if (lstat(resolved, &found) != 0 || !S_ISLNK(found.st_mode)) return resolved;
    next = links < MOST_LINKS ? follow_link(resolved) : NULL;
    if (next == NULL && links == MOST_LINKS) errno = ELOOP;
    free(resolved);
    resolved = next;
  }
  return NULL;
}

/* Whether the rest of a name after ".part" is a process, which is then in `process`, and perhaps a number. */
static int is_of_process(const char *rest, long *process) {
  char *end;
  if (rest[0] < '0' || rest[0] > '9') return 0;
  *process = strtol(rest, &end, 10);
  if (end[0] == '-' && end[1] >= '0' && end[1] <= '9') (void)strtol(end + 1, &end, 10);
  return end[0] == '\0';
}

/* Remove what killed processes have left beside `target`: parts of processes that are not on this machine, and that nothing
   has changed for an hour (the process could be on another machine that shares the folder). */
static void remove_left_parts(const char *target) {
  const size_t before = folder_length(target), length = strlen(target + before);
  char *folder = folder_of(target), *path;
  DIR *names = folder == NULL ? NULL : opendir(folder);
  struct dirent *entry;
  struct stat found;
  long process;
  free(folder);
  if (names == NULL) return;
  while ((entry = readdir(names)) != NULL) {
    if (strncmp(entry->d_name, target + before, length) != 0) continue;
    if (strncmp(entry->d_name + length, ending, sizeof ending - 1) != 0) continue;
    if (!is_of_process(entry->d_name + length + sizeof ending - 1, &process)) continue;
    if (kill((pid_t)process, 0) == 0 || errno != ESRCH) continue;
    path = malloc(before + strlen(entry->d_name) + 1);
    if (path == NULL) continue;
    memcpy(path, target, before);
    strcpy(path + before, entry->d_name);
    if (lstat(path, &found) == 0 && S_ISREG(found.st_mode) && difftime(time(NULL), found.st_mtime) > STALE_AGE) unlink(path);
    free(path);
  }
  closedir(names);
}

/* Make a new empty file beside `target`, under a name that nobody has: `part`, a new string. */
static int make_part(const char *target, mode_t mode, char **part, int *descriptor) {
  const size_t length = strlen(target) + sizeof ending + 48;
  int number;
  *part = malloc(length);
  if (*part == NULL) return ENOMEM;
  for (number = 0; number < MOST_NAMES; number++) {
    if (number == 0) snprintf(*part, length, "%s%s%ld", target, ending, (long)getpid());
    if (number > 0) snprintf(*part, length, "%s%s%ld-%d", target, ending, (long)getpid(), number);
    *descriptor = open(*part, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, mode);
    if (*descriptor >= 0) return 0;
    if (errno != EEXIST) return errno;
  }
  return EEXIST;
}

/* Begin a file that is to become `path`: `part` is the name to write under, made anew and empty, `target` the file behind
   `path`; both are new strings, which the caller frees whatever is returned. `descriptor`: the file, open. What is at `path`
   must be nothing (or a link to nothing), or a regular file that may be written; the part has its mode. */
int mfv_begin_replacement(const char *path, char **target, char **part, int *descriptor) {
  struct stat old;
  int code, is_there;
  *part = NULL;
  *target = resolve(path);
  if (*target == NULL) return errno;
  is_there = stat(*target, &old) == 0;
  if (!is_there && errno != ENOENT) return errno;
  if (is_there && S_ISDIR(old.st_mode)) return EISDIR;
  if (is_there && !S_ISREG(old.st_mode)) return NOT_REGULAR;
  if (is_there && access(*target, W_OK) != 0) return errno;
  remove_left_parts(*target);
  code = make_part(*target, 0666, part, descriptor);
  if (code != 0 || !is_there) return code;
  /* The owner can be kept by root alone, and the group by its members. */
  if (fchown(*descriptor, old.st_uid, old.st_gid) != 0) errno = 0;
  if (fchmod(*descriptor, old.st_mode & 0777) == 0) return 0;
  code = errno;
  close(*descriptor);
  unlink(*part);
  return code;
}

/* Write bytes where the open file is, all of them or an error. */
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

/* What tells whether a file is still the same: device, number, size, time of its last change; all -1 where there is none. */
void mfv_identify_file(const char *path, int64_t identity[5]) {
  struct stat found;
  int i;
  for (i = 0; i < 5; i++) identity[i] = -1;
  if (stat(path, &found) != 0) return;
  identity[0] = (int64_t)found.st_dev;
  identity[1] = (int64_t)found.st_ino;
  identity[2] = (int64_t)found.st_size;
  identity[3] = (int64_t)found.st_mtim.tv_sec;
  identity[4] = (int64_t)found.st_mtim.tv_nsec;
}

/* Have the disk take what has been written to an open file. A file system that cannot is no failure. */
static int sync_file(int descriptor) {
  if (fsync(descriptor) == 0 || errno == EINVAL || errno == ENOTSUP || errno == ENOSYS) return 0;
  return errno;
}

/* Have the disk take the entries of the folder of `path`. A folder that may be written and not read is no failure. */
static int sync_folder(const char *path) {
  char *folder = folder_of(path);
  int code, descriptor = folder == NULL ? -1 : open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  free(folder);
  if (descriptor < 0) return 0;
  code = sync_file(descriptor);
  close(descriptor);
  return code;
}

/* Give the part, which has been written, and closed by others that have had it open, the name `target`: its bytes are on the disk before it has the
   name, so that also after a power cut there is the old file or the new one. The descriptor is closed, and the part is gone
   in any case. `expected`: what `target` must still be, null: anything. `is_in_place`: whether the new file has the name, which
   it has where only the last step, the folder, failed. */
int mfv_finish_replacement(int descriptor, const char *part, const char *target, const int64_t *expected, int *is_in_place) {
  int64_t found[5];
  int code = sync_file(descriptor);
  if (close(descriptor) != 0 && code == 0) code = errno;
  if (code == 0 && expected != NULL) {
    mfv_identify_file(target, found);
    if (memcmp(found, expected, sizeof found) != 0) code = CHANGED;
  }
  if (code == 0 && rename(part, target) != 0) code = errno;
  *is_in_place = code == 0;
  if (code == 0) return sync_folder(target);
  unlink(part);
  return code;
}

/* Remove the part; the file that it was to replace stays. */
void mfv_drop_replacement(int descriptor, const char *part) {
  close(descriptor);
  unlink(part);
}

/* What such a code means, in words. */
void mfv_describe_error(int code, char *text, size_t length) {
  if (code == NOT_REGULAR)
    snprintf(text, length, "it is no regular file");
  else if (code == CHANGED)
    snprintf(text, length, "another process has replaced it in the meantime; start again");
  else if (strerror_r(code, text, length) != 0) snprintf(text, length, "error %d", code);
}
