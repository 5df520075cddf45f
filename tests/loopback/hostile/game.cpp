// A game that attacks its server before its main() begins. It writes each attempt and its result into the
// file "report" in its working directory, which is allowed. HostileGameTest.cpp reads this file. Without a
// sandbox the game harms only that server.
#include <fcntl.h>
#include <linux/fs.h>
#include <linux/fsverity.h>
#include <linux/sched.h>
#include <sched.h>
#include <stdlib.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/ptrace.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <sys/wait.h>
#include <sys/xattr.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "DisplayManager.h"
#include "GameManager.h"
#include "Object.h"

using namespace df;

namespace {

void report(const std::string& line) {
  std::ofstream("report", std::ios::app) << getpid() << " " << line << std::endl;
}

/// Reports an attempt. `result` is the result of its system call, −1 if it failed with errno.
void attempt(const std::string& name, long result) {
  const bool refused = result < 0 && (errno == EPERM || errno == EACCES || errno == ENOSYS || errno == EXDEV);
  report(name + (result >= 0 ? ": done" : refused ? ": refused" : ": error " + std::to_string(errno)));
}

long tryOpen(const std::string& path, int flags) {
  const int file = open(path.c_str(), flags | O_CLOEXEC, 0600);
  if (file >= 0) close(file);
  return file;
}

void attackFiles(const std::string& front) {
  attempt("read the key", tryOpen("../identity/key.pem", O_RDONLY));
  attempt("empty the key", truncate("../identity/key.pem", 0));
  attempt("list the server's folder", tryOpen("..", O_RDONLY | O_DIRECTORY));
  attempt("empty the log", tryOpen("../log", O_WRONLY | O_TRUNC));
  attempt("make a file elsewhere", tryOpen("../outside", O_WRONLY | O_CREAT));
  attempt("make a folder elsewhere", mkdir("../outside", 0700));
  attempt("make a link", symlink("../identity/key.pem", "link"));
  attempt("link the key", link("../identity/key.pem", "hard"));
  attempt("read the front's memory", tryOpen("/proc/" + front + "/mem", O_RDWR));
  attempt("read the front's environment", tryOpen("/proc/" + front + "/environ", O_RDONLY));
  attempt("read the front's command line", tryOpen("/proc/" + front + "/cmdline", O_RDONLY));
  attempt("read /etc/passwd", tryOpen("/etc/passwd", O_RDONLY));
  attempt("write into its own folder", tryOpen("scores", O_WRONLY | O_CREAT | O_TRUNC));
  attempt("read what it wrote", tryOpen("scores", O_RDONLY));
  attempt("read a library", tryOpen("/usr/lib", O_RDONLY | O_DIRECTORY));
}

void attackCalls(pid_t front) {
  attempt("make readable the key", chmod("../identity/key.pem", 0666));
  attempt("socket", socket(AF_INET, SOCK_STREAM, 0));
  attempt("local socket", socket(AF_UNIX, SOCK_STREAM, 0));
  int pair[2];
  attempt("datagram sockets", socketpair(AF_UNIX, SOCK_DGRAM, 0, pair));
  attempt("trace the front", ptrace(PTRACE_ATTACH, front, nullptr, nullptr));
  char byte = 0;
  iovec mine{&byte, 1};
  iovec theirs{&byte, 1};
  attempt("read memory", process_vm_readv(front, &mine, 1, &theirs, 1, 0));
  attempt("write memory", process_vm_writev(front, &mine, 1, &theirs, 1, 0));
  const rlimit none{0, 0};
  attempt("limit the front", syscall(SYS_prlimit64, front, RLIMIT_NOFILE, &none, nullptr));
  attempt("slow down the front", setpriority(PRIO_PROCESS, static_cast<id_t>(front), 19));
  cpu_set_t first;
  CPU_ZERO(&first);
  CPU_SET(0, &first);
  attempt("move the front", sched_setaffinity(front, sizeof first, &first));
  attempt("outlive its supervisor", prctl(PR_SET_PDEATHSIG, 0));
  attempt("hide in /proc", prctl(PR_SET_DUMPABLE, 0));
  const pid_t child = fork();
  if (child == 0) _exit(setsid() < 0 && errno == EPERM && setpgid(0, 0) < 0 && errno == EPERM ? 1 : 0);
  int status = 0;
  waitpid(child, &status, 0);
  errno = EPERM;
  attempt("leave its process group", WIFEXITED(status) && WEXITSTATUS(status) == 1 ? -1 : 0);
  attempt("bpf", syscall(SYS_bpf, 0, nullptr, 0));
  attempt("mount", syscall(SYS_mount, "none", "nowhere", "tmpfs", 0, nullptr));
  attempt("keyctl", syscall(SYS_keyctl, 0, -3, 1));
  attempt("perf_event_open", syscall(SYS_perf_event_open, nullptr, 0, -1, -1, 0));
  attempt("unshare", unshare(CLONE_NEWUSER));
  attempt("userfaultfd", syscall(SYS_userfaultfd, 0));
  attempt("io_uring_setup", syscall(425, 1, nullptr));
  attempt("a call of tomorrow", syscall(999));
}

/// Attacks the metadata of a file that games may open for reading. Without a sandbox these calls change
/// nothing.
void attackOpenFiles() {
  const int server = open("/proc/self/exe", O_RDONLY | O_CLOEXEC);
  struct stat facts {};
  if (server < 0 || fstat(server, &facts) != 0) return;
  attempt("change the server's mode", fchmod(server, facts.st_mode & 07777));
  attempt("change the server's owner", fchown(server, facts.st_uid, facts.st_gid));
  attempt("mark the server", fsetxattr(server, "user.naiad", "", 0, XATTR_REPLACE));
  attempt("unmark the server", fremovexattr(server, "user.naiad"));
  long flags = 0;
  ioctl(server, FS_IOC_GETFLAGS, &flags);
  attempt("flag the server", ioctl(server, FS_IOC_SETFLAGS, &flags));
  attempt("seal the server", ioctl(server, FS_IOC_ENABLE_VERITY, nullptr));
  attempt("lease the server", fcntl(server, F_SETLEASE, F_UNLCK));
  close(server);
}

/// Attacks the server's log, which goes to its standard error or to a file.
void attackLog() {
  attempt("write into the log", tryOpen("../log", O_WRONLY));
  attempt("write into the output", tryOpen("../output", O_WRONLY));
  attempt("empty the output", ftruncate(STDERR_FILENO, 0));
  attempt("overwrite the output", lseek(STDERR_FILENO, 0, SEEK_SET));
  const int flags = fcntl(STDERR_FILENO, F_GETFL);
  attempt("hold up those who print", fcntl(STDERR_FILENO, F_SETFL, (flags | O_NONBLOCK) & ~O_APPEND));
  const std::string line = "192.0.2.9:1 \"nobody\" joined\x1b[2J\n";
  fcntl(STDERR_FILENO, F_SETFL, flags);
  attempt("print", write(STDERR_FILENO, line.data(), line.size()));
}

void attackProcesses(pid_t front) {
  attempt("kill the front", kill(front, SIGKILL));
  attempt("kill its supervisor", kill(getppid(), SIGKILL));
}

void useRuntime() {
  bool ran = false;
  std::thread([&ran] { ran = true; }).join();
  attempt("thread", ran ? 0 : -1);
  const pid_t child = fork();
  if (child == 0) _exit(7);
  int status = 0;
  waitpid(child, &status, 0);
  attempt("child", WIFEXITED(status) && WEXITSTATUS(status) == 7 ? 0 : -1);
  char bytes[8];
  attempt("getrandom", syscall(SYS_getrandom, bytes, sizeof bytes, 0));
  attempt("personality", syscall(SYS_personality, 0xffffffff));
  attempt("program", system("true") == 0 ? 0 : -1);
}

/// Leaves two children: one in its own session if allowed, and one whose parent has ended.
void leaveChildren() {
  int ends[2];
  if (pipe(ends) != 0) return;
  const std::string child = "child of " + std::to_string(getpid());
  if (fork() == 0) {
    setsid();
    report(child);
    if (fork() == 0) {
      if (fork() != 0) _exit(0);
      setsid();
      report(child);
    }
    close(ends[1]);
    while (true) pause();
  }
  close(ends[1]);
  char byte = 0;
  [[maybe_unused]] const ssize_t none = read(ends[0], &byte, 1);  // returns when both children have reported
  close(ends[0]);
}

// Sanitizers record every block, and the memory limit does not apply to programs with them, so fewer blocks
// are tried.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr std::size_t kMaxBlocks = 64;
#else
constexpr std::size_t kMaxBlocks = 16'384;
#endif

void takeEverything() {
  std::vector<int> files;
  for (int file = 0; files.size() < 100'000 && (file = open("/dev/null", O_RDONLY)) >= 0;)
    files.push_back(file);
  for (const int file : files) close(file);
  report("descriptors: " + std::to_string(files.size()));
  constexpr std::size_t kStep = std::size_t{64} << 20;
  std::vector<void*> blocks;
  while (blocks.size() < kMaxBlocks) {
    void* p_block =
        mmap(nullptr, kStep, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (p_block == MAP_FAILED) break;
    blocks.push_back(p_block);
  }
  report("megabytes: " + std::to_string(blocks.size() * 64));
  for (void* p_block : blocks) munmap(p_block, kStep);
  rlimit core{};
  getrlimit(RLIMIT_CORE, &core);
  report("core: " + std::to_string(core.rlim_max));
}

struct Attack {
  Attack() {
    report("begun");
    pid_t front = 0;
    std::ifstream("front") >> front;
    if (front <= 1) return;  // the test has not written the file yet
    attackFiles(std::to_string(front));
    attackCalls(front);
    attackOpenFiles();
    attackLog();
    attackProcesses(front);
    useRuntime();
    takeEverything();
    leaveChildren();
    report("attacked");
  }
};
const Attack g_attack;

class Mark : public Object {
 public:
  Mark() { setPosition(Vector(40, 12)); }
  int draw() { return DM.drawString(getPosition(), "hostile", CENTER_JUSTIFIED, YELLOW); }
};

}  // namespace

int main() {
  GM.startUp();
  new Mark;
  GM.run();
  GM.shutDown();
  return 0;
}
