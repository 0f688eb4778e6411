"""A terminal for programs that show progress on one."""

import fcntl
import os
import pty
import struct
import subprocess
import termios

#: Lines and columns of the terminal.
SIZE = 24, 100


def shown_on_a_terminal(command, **options):
    """All that a command shows on its standard error where that is a terminal, as bytes. `options`: of subprocess.Popen."""
    master, slave = pty.openpty()
    fcntl.ioctl(slave, termios.TIOCSWINSZ, struct.pack("HHHH", *SIZE, 0, 0))
    run = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=slave, **options)
    os.close(slave)
    seen = b""
    while True:
        try:
            part = os.read(master, 1000)
        except OSError:
            break
        if not part:
            break
        seen += part
    run.communicate(timeout=60)
    os.close(master)
    return seen
