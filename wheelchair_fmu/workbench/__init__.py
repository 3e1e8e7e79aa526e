"""The workbench: the loop in a browser, served on this machine only.

::

    page/*.js  ──HTTP──  server  ── session: a folder with all there is of one piece of work
                            └────── jobs: the wheelchair command as a child process, which can be cancelled

A session is a folder, so a reload or a restart loses nothing; every visit to / starts another, so that tabs do not
disturb each other. Long work is what a user could type: the page shows the command.
"""
