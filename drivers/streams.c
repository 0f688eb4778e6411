/* The standard streams of a program, and a signal. In C because open flags and the numbers of signals are the system's own. */
#define _XOPEN_SOURCE 700
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

/* To be called first. A standard stream that the caller has closed is opened on /dev/null: else the next file, a result for
   one, would get its number, and the summary would go into it. It is opened so that printing fails and messages vanish. And
   a file that may not grow further is an error of the call that writes, not the end of the program by a signal. */
void mfv_begin_streams(void) {
  int descriptor;
  for (descriptor = STDIN_FILENO; descriptor <= STDERR_FILENO; descriptor++)
    if (fcntl(descriptor, F_GETFD) < 0 && errno == EBADF) open("/dev/null", descriptor == STDERR_FILENO ? O_WRONLY : O_RDONLY);
  signal(SIGXFSZ, SIG_IGN);
}
