"""A Slurm cluster of one node, in a temporary folder and on loopback only, for checks against the real thing.

Wants root and Debian's packages slurmctld, slurmd and slurm-client. Nothing of /etc/slurm is read or written: whoever
gets `environment` speaks to this cluster, everybody else does not.
"""

import os
import pathlib
import shutil
import signal
import socket
import subprocess
import tempfile
import time

# proctrack/linuxproc and task/none: no cgroups, which containers rarely have. auth/none and cred/none: whoever
# reaches the port is believed, so loopback only. The times are those of a test: of a job that ends, is asked to end, or
# waits to be started. Without AccountingStorage sacct knows nothing, as on many small clusters.
CONFIGURATION = """
ClusterName=lacuna
SlurmctldHost={host}(127.0.0.1)
SlurmUser=root
SlurmdUser=root
AuthType=auth/none
CredType=cred/none
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
SlurmctldPort={ports[0]}
SlurmdPort={ports[1]}
SwitchType=switch/none
MpiDefault=none
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobCompType=jobcomp/none
AccountingStorageType=accounting_storage/none
JobAcctGatherType=jobacct_gather/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core_Memory
SchedulerType=sched/backfill
SchedulerParameters=sched_interval=1,bf_interval=1,sched_min_interval=0,batch_sched_delay=0,defer_batch
PriorityType=priority/basic
PreemptType=preempt/partition_prio
PreemptMode=REQUEUE
ReturnToService=2
SlurmdTimeout=10
SlurmctldTimeout=10
KillWait=5
CompleteWait=0
MinJobAge=300
InactiveLimit=0
Waittime=0
MessageTimeout=5
MaxJobCount=20000
UnkillableStepTimeout=60
NodeName={host} NodeAddr=127.0.0.1 CPUs={cpus} Boards=1 SocketsPerBoard=1 CoresPerSocket={cpus} ThreadsPerCore=1 \
RealMemory={megabytes} State=UNKNOWN
PartitionName=main Nodes={host} Default=YES MaxTime=INFINITE DefaultTime=60 State=UP PriorityTier=1 GraceTime=0
PartitionName=urgent Nodes={host} Default=NO MaxTime=INFINITE State=UP PriorityTier=10 PreemptMode=OFF
"""
PROGRAMS = ("slurmctld", "slurmd", "sbatch", "squeue", "scancel", "scontrol")


def free_ports(count):
    sockets = [socket.socket() for _ in range(count)]
    for each in sockets:
        each.bind(("127.0.0.1", 0))
    ports = [each.getsockname()[1] for each in sockets]
    for each in sockets:
        each.close()
    return ports


class Cluster:
    """Context manager: the cluster runs inside."""

    def __init__(self, cpus=2, megabytes=4096):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="lacuna-slurm-"))
        for name in ("state", "spool"):
            (self.folder / name).mkdir()
        self.host = socket.gethostname().split(".")[0]
        configuration = CONFIGURATION.format(host=self.host, folder=self.folder, ports=free_ports(2), cpus=cpus,
                                             megabytes=megabytes)
        (self.folder / "slurm.conf").write_text(configuration)
        self.environment = {**os.environ, "SLURM_CONF": str(self.folder / "slurm.conf")}
        self.daemons = {}
        self.keep = False

    def __enter__(self):
        self.start("slurmctld")
        self.start("slurmd")
        try:
            self.wait_for_node()
        except Exception:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        self.run("scancel", "--signal=KILL", "--full", "--state=RUNNING", "--user=root", check=False)
        self.run("scancel", "--user=root", check=False)
        for name in list(self.daemons):
            self.kill(name, signal.SIGTERM)
        if not self.keep:
            shutil.rmtree(self.folder, ignore_errors=True)

    def start(self, name):
        """Starts slurmctld or slurmd, in the foreground of a process of our own."""
        command = [shutil.which(name) or f"/usr/sbin/{name}", "-D"] + (["-N", self.host] if name == "slurmd" else [])
        log = open(self.folder / f"{name}.out", "ab")
        self.daemons[name] = subprocess.Popen(command, env=self.environment, stdin=subprocess.DEVNULL, stdout=log,
                                              stderr=log, start_new_session=True)
        log.close()

    def kill(self, name, number=signal.SIGKILL):
        """Only the daemon: its steps (slurmstepd) run on, as they do when a real one dies."""
        daemon = self.daemons.pop(name)
        daemon.send_signal(number)
        daemon.wait()

    def wait_for_node(self, seconds=60):
        """Until the node takes jobs. One that was lost for long is brought back by hand, as an administrator does."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            state = self.run("sinfo", "-h", "-p", "main", "-o", "%T", check=False).strip()
            if state in ("idle", "mixed", "allocated", "completing"):
                return
            if state.startswith(("down", "drained")):
                self.run("scontrol", "update", f"NodeName={self.host}", "State=RESUME", check=False)
            time.sleep(0.2)
        raise RuntimeError(f"the node is {state!r}: see {self.folder}/slurmd.log")

    def run(self, *command, check=True):
        """Standard output of one of Slurm's programs."""
        done = subprocess.run(command, env=self.environment, capture_output=True, text=True, check=False, timeout=60)
        if check and done.returncode != 0:
            raise RuntimeError(f"{' '.join(command)}: {done.stderr.strip()}")
        return done.stdout
