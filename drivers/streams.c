/* The standard streams of a program, and a signal. In C because open flags and signal numbers depend on the system. */
#define _XOPEN_SOURCE 700
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
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
