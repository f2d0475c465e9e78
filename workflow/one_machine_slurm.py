# SPDX-License-Identifier: Apache-2.0
"""A real Slurm of one node on this machine, for tests: munged, slurmctld and slurmd on the loopback, all in one folder."""
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import time

PROGRAMS = ("munged", "slurmctld", "slurmd", "sbatch", "scontrol", "sinfo")
NODE = "one"

CONFIGURATION = """\
ClusterName=test
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={controller_port}
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
CryptoType=crypto/munge
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU_Memory
SlurmdParameters=config_overrides
ReturnToService=2
SchedulerParameters=sched_interval=1,sched_min_interval=0,batch_sched_delay=0
NodeName={node} NodeHostname={host} NodeAddr=127.0.0.1 Port={node_port} CPUs=4 RealMemory=64000
PartitionName=all Nodes={node} Default=YES State=UP
"""


def why_not():
    """Why there can be no Slurm here; nothing if there can."""
    missing = [name for name in PROGRAMS if shutil.which(name, path=f"{os.environ['PATH']}:/usr/sbin") is None]
    if missing:
        return f"no {', '.join(missing)}: tools/setup --cluster installs them"
    return "Slurm's daemons need root" if os.geteuid() != 0 else None


def wait_until(condition, what, seconds=60):
    """The first value of `condition` that is true."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        value = condition()
        if value:
            return value
        time.sleep(0.05)
    raise AssertionError(f"waited {seconds} s for {what}")


def _free_ports(count):
    sockets = [socket.create_server(("127.0.0.1", 0)) for _ in range(count)]
    ports = [opened.getsockname()[1] for opened in sockets]
    for opened in sockets:
        opened.close()
    return ports


def _read(path):
    try:
        return path.read_bytes()
    except OSError:  # the process has ended
        return b""


class Slurm:
    """Started by `with`; everything is stopped at its end."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        self.configuration = self.folder / "slurm.conf"
        path = f"{os.environ['PATH']}:/usr/sbin"
        self.environment = {**os.environ, "SLURM_CONF": str(self.configuration), "PATH": path}
        self.daemons = {}

    def __enter__(self):
        for name in ("state", "spool"):
            (self.folder / name).mkdir()
        self.folder.chmod(0o755)
        controller_port, node_port = _free_ports(2)
        self.configuration.write_text(CONFIGURATION.format(
            folder=self.folder, host=socket.gethostname().split(".")[0], node=NODE, controller_port=controller_port,
            node_port=node_port))
        key = self.folder / "munge.key"
        key.write_bytes(os.urandom(64))
        key.chmod(0o600)
        try:
            munge = {name: self.folder / f"munge.{name}" for name in ("socket", "pid", "log", "seed")}
            self._start("munged", "--foreground", "--force", f"--key-file={key}", f"--socket={munge['socket']}",
                        f"--pid-file={munge['pid']}", f"--log-file={munge['log']}", f"--seed-file={munge['seed']}")
            wait_until(munge["socket"].exists, "munged")
            self._start("slurmctld", "-D", "-i")
            self.start_node()
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        self.kill_node()
        for daemon in self.daemons.values():
            daemon.terminate()
        for daemon in self.daemons.values():
            daemon.wait(timeout=20)

    def _start(self, name, *arguments):
        with open(self.folder / f"{name}.out", "a") as out:
            self.daemons[name] = subprocess.Popen([name, *arguments], env=self.environment, stdout=out, stderr=out)

    def start_node(self):
        self._start("slurmd", "-D", "-N", NODE)
        wait_until(lambda: self._state() in ("idle", "mixed", "allocated", "completing"), f"the node, see {self.folder}/*.log")

    def lose_node(self):
        """The node dies, and Slurm is told, which by itself would notice after SlurmdTimeout."""
        self.kill_node()
        down = ["scontrol", "update", f"nodename={NODE}", "state=down", "reason=lost"]
        subprocess.run(down, env=self.environment, check=True)

    def _state(self):
        asked = subprocess.run(["sinfo", "--noheader", "--format=%T"], env=self.environment, capture_output=True, text=True)
        return asked.stdout.strip()

    def job_processes(self):
        """By id, the command lines of all processes of all jobs, their keepers (slurmstepd) included."""
        mine = b"SLURM_CONF=" + os.fsencode(self.configuration) + b"\0"
        found = {}
        for entry in pathlib.Path("/proc").glob("[0-9]*"):
            environment, command = _read(entry / "environ"), _read(entry / "cmdline")
            if mine in environment and (b"SLURM_JOB_ID=" in environment or command.startswith(b"slurmstepd")):
                found[int(entry.name)] = os.fsdecode(command).split("\0")
        return found

    def kill_node(self):
        """As a node that loses its power: its daemon and all processes of its jobs end at once."""
        daemon = self.daemons.pop("slurmd", None)
        if daemon:
            daemon.kill()
            daemon.wait()
        for process in self.job_processes():
            try:
                os.kill(process, signal.SIGKILL)
            except ProcessLookupError:
                pass
