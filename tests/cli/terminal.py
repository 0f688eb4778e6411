"""A terminal for programs that show progress on one."""

import os
import pty
import subprocess


def shown_on_a_terminal(command, **options):
    """All that a command shows on its standard error where that is a terminal, as bytes. `options`: of subprocess.Popen."""
    master, slave = pty.openpty()
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
