//! A Slurm with two nodes on this machine, without systemd: the daemons are processes of the test, which ends them by their
//! numbers.

use nix::sys::signal::{Signal, kill};
use nix::unistd::{Pid, geteuid};
use std::collections::BTreeSet;
use std::ffi::OsStr;
use std::fs;
use std::net::TcpListener;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

const PROGRAMS: [&str; 6] = ["munged", "slurmctld", "slurmd", "sbatch", "squeue", "scontrol"];

/// A running Slurm.
pub struct Cluster {
    /// Configuration, keys, logs and state. It is deleted after the daemons have ended.
    folder: tempfile::TempDir,
    /// The daemons, in the order in which they were started.
    daemons: Vec<(String, Child)>,
}

impl Cluster {
    /// Starts the daemons. `None`, with a message, if Slurm is not installed or this user may not start it.
    pub fn start() -> Option<Cluster> {
        let missing: Vec<&str> = PROGRAMS.into_iter().filter(|program| !is_installed(program)).collect();
        if !missing.is_empty() {
            println!(
                "SKIPPED: Slurm is not installed ({} missing): apt-get install slurmctld slurmd slurm-client munge",
                missing.join(", ")
            );
            return None;
        }
        if !geteuid().is_root() {
            println!("SKIPPED: only root can start the nodes of a Slurm");
            return None;
        }
        let mut cluster = Cluster { folder: tempfile::tempdir().expect("a folder"), daemons: Vec::new() };
        cluster.configure();
        let file = |name: &str| cluster.folder.path().join(format!("munge.{name}")).display().to_string();
        let files = ["key", "pid", "log", "seed"].map(|name| format!("--{name}-file={}", file(name)));
        let socket = format!("--socket={}", file("socket"));
        let munge = ["--foreground", "--force", &socket].into_iter().chain(files.iter().map(String::as_str));
        let munge: Vec<&str> = munge.collect();
        cluster.daemon("munged", "munged", &munge);
        let socket = cluster.folder.path().join("munge.socket");
        cluster.wait("munged", |_| socket.exists());
        cluster.daemon("slurmctld", "slurmctld", &["-D", "-c"]);
        for node in ["n1", "n2"] {
            cluster.daemon(node, "slurmd", &["-D", "-N", node]);
        }
        cluster.wait("the nodes", |cluster| {
            let nodes = cluster.ask("sinfo", &["-h", "-N", "-o", "%N %t"]);
            nodes.lines().filter(|line| line.trim().ends_with(" idle")).count() == 2
        });
        println!("{} with 2 nodes: {}", cluster.ask("sinfo", &["--version"]).trim(), cluster.processes());
        Some(cluster)
    }

    /// Writes the configuration and the key.
    fn configure(&self) {
        let folder = self.folder.path();
        let [controller, first, second] = free_ports();
        let host = fs::read_to_string("/proc/sys/kernel/hostname").expect("the name of this machine");
        let host = host.trim();
        let shown = folder.display();
        let text = format!(
            "ClusterName=raykata\nSlurmctldHost={host}(127.0.0.1)\nSlurmUser=root\nSlurmdUser=root\n\
             AuthType=auth/munge\nCredType=cred/munge\n\
             # A task whose node was lost waits as long as a credential lives, which is 120 s by default.\n\
             AuthInfo=socket={shown}/munge.socket,cred_expire=10\n\
             SlurmctldPort={controller}\nStateSaveLocation={shown}/state\nSlurmdSpoolDir={shown}/spool-%n\n\
             SlurmctldPidFile={shown}/slurmctld.pid\nSlurmdPidFile={shown}/slurmd-%n.pid\n\
             SlurmctldLogFile={shown}/slurmctld.log\nSlurmdLogFile={shown}/slurmd-%n.log\n\
             ProctrackType=proctrack/linuxproc\nTaskPlugin=task/none\nJobAcctGatherType=jobacct_gather/none\n\
             AccountingStorageType=accounting_storage/none\nSwitchType=switch/none\nMpiDefault=none\n\
             SelectType=select/cons_tres\nSelectTypeParameters=CR_Core\nReturnToService=2\n\
             SlurmdParameters=config_overrides\n\
             NodeName=n1 NodeHostname={host} NodeAddr=127.0.0.1 Port={first} CPUs=2 RealMemory=4000 State=UNKNOWN\n\
             NodeName=n2 NodeHostname={host} NodeAddr=127.0.0.1 Port={second} CPUs=2 RealMemory=4000 State=UNKNOWN\n\
             PartitionName=all Nodes=n1,n2 Default=YES MaxTime=INFINITE State=UP\n"
        );
        fs::write(folder.join("slurm.conf"), text).expect("written");
        // Any bytes make a key for munge, which wants 32 or more.
        let key: Vec<u8> = (0..64)
            .map(|_| std::hash::BuildHasher::hash_one(&std::hash::RandomState::new(), 0) as u8)
            .collect();
        fs::write(folder.join("munge.key"), key).expect("written");
        let secret = std::os::unix::fs::PermissionsExt::from_mode(0o600);
        fs::set_permissions(folder.join("munge.key"), secret).expect("protected");
        for name in ["state", "spool-n1", "spool-n2"] {
            fs::create_dir(folder.join(name)).expect("a folder");
        }
    }

    /// A command that talks to this Slurm.
    pub fn command(&self, program: impl AsRef<OsStr>) -> Command {
        let mut command = Command::new(program);
        command.env("SLURM_CONF", self.folder.path().join("slurm.conf")).env("PATH", search_path());
        command
    }

    /// What a program of Slurm prints.
    pub fn ask(&self, program: &str, arguments: &[&str]) -> String {
        let output = self.command(program).args(arguments).output().expect("a program of Slurm");
        String::from_utf8_lossy(&output.stdout).into_owned()
    }

    fn daemon(&mut self, name: &str, program: &str, arguments: &[&str]) {
        let log = fs::File::create(self.folder.path().join(format!("{name}.out"))).expect("a log");
        let errors = log.try_clone().expect("a log");
        let mut command = self.command(program);
        let child = command.args(arguments).stdin(Stdio::null()).stdout(log).stderr(errors).spawn();
        self.daemons.push((name.to_owned(), child.expect("a daemon")));
    }

    fn wait(&self, what: &str, happened: impl Fn(&Cluster) -> bool) {
        let late = Instant::now() + Duration::from_secs(60);
        while !happened(self) {
            assert!(Instant::now() < late, "{what} did not start:\n{}", self.logs());
            std::thread::sleep(Duration::from_millis(100));
        }
    }

    /// The names and numbers of the daemons.
    fn processes(&self) -> String {
        let names = self.daemons.iter().map(|(name, child)| format!("{name} {}", child.id()));
        names.collect::<Vec<_>>().join(", ")
    }

    /// The ends of all logs.
    fn logs(&self) -> String {
        let mut files: Vec<PathBuf> = fs::read_dir(self.folder.path())
            .into_iter()
            .flatten()
            .flatten()
            .map(|entry| entry.path())
            .filter(|path| path.extension().is_some_and(|ending| ending == "log" || ending == "out"))
            .collect();
        files.sort();
        let end = |file: &PathBuf| {
            let text = fs::read_to_string(file).unwrap_or_default();
            let lines: Vec<&str> = text.lines().collect();
            format!("== {}\n{}\n", file.display(), lines[lines.len().saturating_sub(15)..].join("\n"))
        };
        files.iter().map(end).collect()
    }

    /// Kills a node with all that runs on it, as a loss of power does, and tells the controller. Returns the numbers of the
    /// killed processes.
    pub fn lose(&mut self, node: &str) -> Vec<i32> {
        let place = self.daemons.iter().position(|(name, _)| name == node).expect("a node");
        let (_, mut daemon) = self.daemons.remove(place);
        let mut killed = vec![daemon.id() as i32];
        killed.extend(self.running_on(node));
        for process in &killed {
            let _ = kill(Pid::from_raw(*process), Signal::SIGKILL);
        }
        let _ = daemon.wait();
        self.ask("scontrol", &["update", &format!("nodename={node}"), "state=down", "reason=lost"]);
        killed
    }

    /// The processes of the tasks on a node, and the processes of Slurm that started them.
    fn running_on(&self, node: &str) -> BTreeSet<i32> {
        let processes = processes();
        let configuration = format!("SLURM_CONF={}", self.folder.path().join("slurm.conf").display());
        let node = format!("SLURMD_NODENAME={node}");
        let is_task = |process: &i32| {
            let environment = fs::read(format!("/proc/{process}/environ")).unwrap_or_default();
            let has = |word: &str| environment.split(|byte| *byte == 0).any(|one| one == word.as_bytes());
            has(&configuration) && has(&node)
        };
        let tasks: BTreeSet<i32> = processes.iter().map(|(process, _)| *process).filter(is_task).collect();
        // The parent of a task is the process of Slurm that watches it.
        let parents =
            processes.iter().filter(|(process, _)| tasks.contains(process)).map(|(_, parent)| *parent);
        let parents = parents.filter(|parent| command_of(*parent).starts_with("slurmstepd"));
        let mut all: BTreeSet<i32> = tasks.iter().copied().chain(parents).collect();
        // Sandboxed processes have no such environment, but their parents have.
        loop {
            let more: Vec<i32> = processes
                .iter()
                .filter(|(process, parent)| all.contains(parent) && !all.contains(process))
                .map(|(process, _)| *process)
                .collect();
            if more.is_empty() {
                return all;
            }
            all.extend(more);
        }
    }

    /// Ends the daemons, each by its number, and waits for them.
    pub fn stop(mut self) {
        let processes = self.processes();
        self.end();
        println!("stopped: {processes}");
    }

    fn end(&mut self) {
        let tasks: Vec<i32> = ["n1", "n2"].iter().flat_map(|node| self.running_on(node)).collect();
        for process in tasks {
            let _ = kill(Pid::from_raw(process), Signal::SIGKILL);
        }
        // The nodes first, and what they need last.
        for (_, mut daemon) in self.daemons.drain(..).rev() {
            let _ = kill(Pid::from_raw(daemon.id() as i32), Signal::SIGTERM);
            let late = Instant::now() + Duration::from_secs(10);
            while matches!(daemon.try_wait(), Ok(None)) && Instant::now() < late {
                std::thread::sleep(Duration::from_millis(50));
            }
            let _ = daemon.kill();
            let _ = daemon.wait();
        }
    }
}

impl Drop for Cluster {
    fn drop(&mut self) {
        if std::thread::panicking() {
            println!("{}", self.logs());
        }
        self.end();
    }
}

/// The daemons lie in a folder that only the search path of root has.
fn search_path() -> String {
    format!("{}:/usr/sbin:/usr/local/sbin", std::env::var("PATH").unwrap_or_default())
}

fn is_installed(program: &str) -> bool {
    search_path().split(':').any(|folder| Path::new(folder).join(program).is_file())
}

/// Three ports that no program listens on.
fn free_ports() -> [u16; 3] {
    let listeners = [0; 3].map(|_| TcpListener::bind(("127.0.0.1", 0)).expect("a port"));
    listeners.map(|listener| listener.local_addr().expect("a port").port())
}

/// All processes, each with its parent.
fn processes() -> Vec<(i32, i32)> {
    let numbers = fs::read_dir("/proc").into_iter().flatten().flatten();
    let numbers = numbers.filter_map(|entry| entry.file_name().to_str()?.parse().ok());
    let with_parent = |process: i32| {
        let text = fs::read_to_string(format!("/proc/{process}/stat")).ok()?;
        // The name of the program, in parentheses, may contain blanks.
        let parent = text.rsplit_once(") ")?.1.split(' ').nth(1)?.parse().ok()?;
        Some((process, parent))
    };
    numbers.filter_map(with_parent).collect()
}

fn command_of(process: i32) -> String {
    fs::read_to_string(format!("/proc/{process}/comm")).unwrap_or_default()
}
