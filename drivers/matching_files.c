/* Files whose names begin and end in a certain way. In C because the layout of glob_t is the system's own. */
#include <glob.h>
#include <stdlib.h>
#include <string.h>

/* Paths that begin with `start`, go on with anything but a slash, and end with `end`: joined by line feeds into a new
   string, which the caller frees; null where there are none. */
char *mfv_matching_files(const char *start, const char *end) {
  glob_t found;
  char *pattern = malloc(2 * strlen(start) + strlen(end) + 2), *at = pattern, *names = NULL;
  size_t i, length = 1;
  if (pattern == NULL) return NULL;
  for (; *start != '\0'; start++) {
    if (strchr("[]*?\\", *start) != NULL) *at++ = '\\';
    *at++ = *start;
  }
  *at++ = '*';
  strcpy(at, end);
  if (glob(pattern, 0, NULL, &found) == 0) {
    for (i = 0; i < found.gl_pathc; i++) length += strlen(found.gl_pathv[i]) + 1;
    names = malloc(length);
    if (names != NULL) names[0] = '\0';
    for (i = 0; names != NULL && i < found.gl_pathc; i++) {
      if (i > 0) strcat(names, "\n");
      strcat(names, found.gl_pathv[i]);
    }
    globfree(&found);
  }
  free(pattern);
  return names;
}
