"""A Slurm controller and two daemons on this machine, for tests: in a folder of their own, as the
user who runs them, with a munge of their own. Nothing of the machine's own Slurm is touched.

usage: python3 loopback_slurm.py COMMAND [ARGUMENT...]     runs a command with the cluster at hand
"""

import contextlib
import getpass
import os
import secrets
import shutil
import socket
import subprocess
import sys
import tempfile
import time

CONFIGURATION = """
ClusterName=loopback
SlurmctldHost={host}(127.0.0.1)
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
CredType=cred/munge
SlurmctldPort={ports[0]}
SlurmctldPidFile={folder}/slurmctld.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdPidFile={folder}/slurmd.%n.pid
SlurmdLogFile={folder}/slurmd.%n.log
SlurmdSpoolDir={folder}/spool.%n
StateSaveLocation={folder}/state
MpiDefault=none
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SchedulerType=sched/builtin
SchedulerParameters=batch_sched_delay=0,sched_interval=1
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
ReturnToService=2
MinJobAge=60
MaxArraySize=1001
NodeName=one NodeHostname={host} NodeAddr=127.0.0.1 Port={ports[1]} CPUs=1
NodeName=two NodeHostname={host} NodeAddr=127.0.0.1 Port={ports[2]} CPUs=1
PartitionName=all Nodes=one,two Default=YES MaxTime=INFINITE State=UP
"""


def missing():
    """Programs that are needed and not installed."""
    path = os.pathsep.join([os.environ.get("PATH", ""), "/usr/sbin"])
    return [name for name in ("munged", "slurmctld", "slurmd", "sbatch", "sinfo")
            if not shutil.which(name, path=path)]


def free_ports(count):
    sockets = [socket.socket() for _ in range(count)]
    for one in sockets:
        one.bind(("127.0.0.1", 0))
    ports = [one.getsockname()[1] for one in sockets]
    for one in sockets:
        one.close()
    return ports


def _write(path, content, mode=0o600):
    with open(path, "wb") as file:
        os.fchmod(file.fileno(), mode)
        file.write(content)


def _wait(question, what, seconds=60):
    end = time.monotonic() + seconds
    while not question():
        if time.monotonic() > end:
            raise TimeoutError(f"Slurm: {what} is not there after {seconds} s")
        time.sleep(0.1)


@contextlib.contextmanager
def cluster():
    """Yields the environment in which sbatch and the like speak to the cluster; it ends with it."""
    with contextlib.ExitStack() as stack:
        # Paths of sockets are short.
        folder = stack.enter_context(tempfile.TemporaryDirectory(prefix="slurm-", dir="/tmp"))
        os.makedirs(os.path.join(folder, "state"))
        host = socket.gethostname().split(".")[0]
        _write(os.path.join(folder, "slurm.conf"), CONFIGURATION.format(
            host=host, user=getpass.getuser(), folder=folder, ports=free_ports(3)).encode(), 0o644)
        _write(os.path.join(folder, "munge.key"), secrets.token_bytes(128))
        surroundings = {**os.environ, "SLURM_CONF": os.path.join(folder, "slurm.conf"),
                        "PATH": os.environ.get("PATH", "") + ":/usr/sbin"}

        def start(name, *command):
            log = stack.enter_context(open(os.path.join(folder, name + ".out"), "wb"))
            daemon = subprocess.Popen(command, env=surroundings, stdout=log, stderr=log,
                                      start_new_session=True)

            def end():
                daemon.terminate()
                try:
                    daemon.wait(20)
                except subprocess.TimeoutExpired:
                    daemon.kill()
                    daemon.wait()

            stack.callback(end)
            return daemon

        def in_folder(name):
            return os.path.join(folder, name)

        start("munged", "munged", "--foreground", "--force", f"--socket={in_folder('munge.socket')}",
              f"--key-file={in_folder('munge.key')}", f"--pid-file={in_folder('munge.pid')}",
              f"--seed-file={in_folder('munge.seed')}", f"--log-file={in_folder('munge.log')}")
        _wait(lambda: os.path.exists(in_folder("munge.socket")), "munged")
        start("slurmctld", "slurmctld", "-D", "-i")
        for node in ("one", "two"):
            start("slurmd." + node, "slurmd", "-D", "-N", node)

        def idle():
            told = subprocess.run(["sinfo", "--noheader", "--Node", "--format=%N %t"], text=True,
                                  env=surroundings, capture_output=True).stdout.split()
            return told == ["one", "idle", "two", "idle"]

        try:
            _wait(idle, "a node")
        except TimeoutError:
            for name in sorted(os.listdir(folder)):
                if name.endswith((".log", ".out")):
                    with open(in_folder(name), encoding="utf-8", errors="replace") as file:
                        print(f"{name}:\n{file.read()[-2000:]}", file=sys.stderr)
            raise
        yield surroundings


if __name__ == "__main__":
    with cluster() as environment:
        sys.exit(subprocess.run(sys.argv[1:], env=environment, check=False).returncode)
