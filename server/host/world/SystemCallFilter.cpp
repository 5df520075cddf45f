#include "host/world/SystemCallFilter.h"

#include <fcntl.h>
#include <linux/audit.h>
#include <linux/sched.h>
#include <linux/seccomp.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/syscall.h>

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace naiad {

namespace {

#if defined(__x86_64__)
#define NAIAD_AUDIT_ARCH AUDIT_ARCH_X86_64
#elif defined(__aarch64__)
#define NAIAD_AUDIT_ARCH AUDIT_ARCH_AARCH64
#elif defined(__riscv) && __riscv_xlen == 64
#define NAIAD_AUDIT_ARCH AUDIT_ARCH_RISCV64
#endif

#ifdef NAIAD_AUDIT_ARCH

/// First number of the x32 calls on x86-64.
constexpr std::uint32_t kX32 = 0x4000'0000;
/// Calls from 424 on have equal numbers on all architectures. The installed headers may not have their names.
constexpr std::uint32_t kPidfdSendSignal = 424;
constexpr std::uint32_t kClone3 = 435;
constexpr std::uint32_t kOpenat2 = 437;
constexpr std::uint32_t kFirstUnknown = 463;

constexpr std::uint32_t kRefused[] = {
    // Sockets: connecting and listening.
    __NR_socket,
    __NR_connect,
    __NR_bind,
    __NR_listen,
    __NR_accept,
    __NR_accept4,
    // Access to other processes.
    __NR_process_vm_readv,
    __NR_process_vm_writev,
    __NR_kcmp,
    kPidfdSendSignal,
    438,  // pidfd_getfd
    440,  // process_madvise
    448,  // process_mrelease
    __NR_move_pages,
    __NR_migrate_pages,
    __NR_perf_event_open,
    __NR_setsid,  // all processes of a world must stay in its group, which is killed as a whole
    __NR_setpgid,
    // Memory that no limit counts, or that is shared with another process.
    __NR_memfd_create,
    447,  // memfd_secret
    __NR_shmget,
    __NR_shmat,
    __NR_shmctl,
    __NR_semget,
    __NR_semctl,
    __NR_semtimedop,
    __NR_semop,
    __NR_msgget,
    __NR_msgctl,
    __NR_msgsnd,
    __NR_msgrcv,
    __NR_mq_open,
    __NR_mq_unlink,
    // Access to files that bypasses Landlock, and operations that Landlock does not restrict.
    __NR_name_to_handle_at,
    __NR_open_by_handle_at,
    __NR_fchmod,  // works even through a descriptor that is open only for reading
    __NR_fchmodat,
    __NR_fchown,
    __NR_fchownat,
    __NR_setxattr,
    __NR_lsetxattr,
    __NR_fsetxattr,
    __NR_removexattr,
    __NR_lremovexattr,
    __NR_fremovexattr,
    452,  // fchmodat2
    __NR_inotify_init1,
    __NR_fanotify_init,
    __NR_quotactl,
    443,  // quotactl_fd
#ifdef __NR_chmod
    __NR_chmod,
    __NR_chown,
    __NR_lchown,
    __NR_utime,
    __NR_utimes,
    __NR_futimesat,
    __NR_inotify_init,
    __NR_uselib,
    __NR_modify_ldt,
    __NR_iopl,
    __NR_ioperm,
#endif
    // Access to the machine as a whole.
    __NR_bpf,
    __NR_userfaultfd,
    425,  // io_uring_setup: opens files and connects sockets without system calls
    426,
    427,
    __NR_keyctl,
    __NR_add_key,
    __NR_request_key,
    __NR_mount,
    __NR_umount2,
    __NR_pivot_root,
    __NR_chroot,
    __NR_unshare,
    __NR_setns,
    428,  // open_tree
    429,  // move_mount
    430,  // fsopen
    431,  // fsconfig
    432,  // fsmount
    433,  // fspick
    442,  // mount_setattr
    457,  // statmount
    458,  // listmount
    459,  // lsm_get_self_attr
    460,
    461,
    __NR_init_module,
    __NR_finit_module,
    __NR_delete_module,
    __NR_kexec_load,
#ifdef __NR_kexec_file_load
    __NR_kexec_file_load,
#endif
    __NR_reboot,
    __NR_swapon,
    __NR_swapoff,
    __NR_acct,
    __NR_settimeofday,
    __NR_clock_settime,
    __NR_clock_adjtime,
    __NR_adjtimex,
    __NR_sethostname,
    __NR_setdomainname,
    __NR_vhangup,
    __NR_syslog,
};

/// ioctl requests with which a world could change a terminal, or send signals. They have equal numbers on all
/// supported architectures.
constexpr std::uint32_t kRefusedControls[] = {
    0x5402,      0x5403,      0x5404,       // TCSETS, TCSETSW, TCSETSF
    0x5406,      0x5407,      0x5408,       // TCSETA, TCSETAW, TCSETAF
    0x402C'542B, 0x402C'542C, 0x402C'542D,  // TCSETS2, TCSETSW2, TCSETSF2
    0x540E,      0x5412,      0x5414,
    0x541C,      0x541D,  // TIOCSCTTY, TIOCSTI, TIOCSWINSZ, TIOCLINUX, TIOCCONS
    0x5423,               // TIOCSETD
    0x8901,      0x8902,  // FIOSETOWN, SIOCSPGRP: signals to other processes
};

/// ioctl requests with which a file's owner can change it permanently, even if it is only open for reading.
constexpr std::uint32_t kRefusedFileControls[] = {
    0x4004'6602, 0x4008'6602,  // FS_IOC_SETFLAGS, with 32 and 64 bits
    0x4004'7602, 0x4008'7602,  // FS_IOC_SETVERSION
    0x401C'5820,               // FS_IOC_FSSETXATTR
    0x4080'6685,               // FS_IOC_ENABLE_VERITY
    0x800C'6613,               // FS_IOC_SET_ENCRYPTION_POLICY
};

constexpr std::uint32_t kNewNamespaces =
    CLONE_NEWNS | CLONE_NEWUTS | CLONE_NEWIPC | CLONE_NEWUSER | CLONE_NEWPID | CLONE_NEWNET | CLONE_NEWCGROUP;

constexpr std::uint32_t kAllow = SECCOMP_RET_ALLOW;

constexpr std::uint32_t fails(int error) {
  return SECCOMP_RET_ERRNO | static_cast<std::uint32_t>(error);
}

/// Writes the filter program instruction by instruction. Between rules the loaded word is the call's number.
class FilterWriter {
 public:
  void load(std::size_t offset) {
    m_code.push_back(BPF_STMT(BPF_LD | BPF_W | BPF_ABS, static_cast<std::uint32_t>(offset)));
  }
  void loadNumber() { load(offsetof(seccomp_data, nr)); }
  /// Loads the low half of an argument, because the kernel reads ints from it.
  void loadArgument(std::size_t n) { load(offsetof(seccomp_data, args) + n * sizeof(std::uint64_t)); }
  void loadArgumentHigh(std::size_t n) {
    load(offsetof(seccomp_data, args) + n * sizeof(std::uint64_t) + sizeof(std::uint32_t));
  }
  void mask(std::uint32_t bits) { m_code.push_back(BPF_STMT(BPF_ALU | BPF_AND | BPF_K, bits)); }
  void end(std::uint32_t verdict) { m_code.push_back(BPF_STMT(BPF_RET | BPF_K, verdict)); }
  void ifEqual(std::uint32_t value, std::uint32_t verdict) { when(BPF_JEQ, value, verdict); }
  void ifOther(std::uint32_t value, std::uint32_t verdict) {
    m_code.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, value, std::uint8_t{1}, std::uint8_t{0}));
    end(verdict);
  }
  void ifAtLeast(std::uint32_t value, std::uint32_t verdict) { when(BPF_JGE, value, verdict); }
  void ifAnyOf(std::uint32_t bits, std::uint32_t verdict) { when(BPF_JSET, bits, verdict); }

  /// Writes a branch for one value of the loaded word: a system call's number, or an argument. If `rule` does
  /// not end the filter program there, the program ends with `verdict`.
  template <class Rule>
  void forCall(std::uint32_t number, std::uint32_t verdict, Rule rule) {
    const std::size_t jump = m_code.size();
    m_code.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, number, 0, 0));
    rule();
    end(verdict);
    m_code[jump].jf = static_cast<std::uint8_t>(m_code.size() - jump - 1);
  }

  std::vector<sock_filter> releaseCode() { return std::move(m_code); }

 private:
  void when(std::uint16_t comparison, std::uint32_t value, std::uint32_t verdict) {
    m_code.push_back(BPF_JUMP(static_cast<std::uint16_t>(BPF_JMP | comparison | BPF_K), value,
                              std::uint8_t{0}, std::uint8_t{1}));
    end(verdict);
  }

  std::vector<sock_filter> m_code;
};

/// Allows a call only if its argument names this process, as 0 or by its number.
void limitToSelf(FilterWriter& out, std::uint32_t call, std::size_t argument, pid_t self) {
  out.forCall(call, fails(EPERM), [&] {
    out.loadArgument(argument);
    out.ifEqual(0, kAllow);
    out.ifEqual(static_cast<std::uint32_t>(self), kAllow);
  });
}

// Replaces Landlock's signal limit. A world's children can then signal only their whole group or the world.
void limitSignals(FilterWriter& out, pid_t self) {
  out.forCall(__NR_kill, fails(EPERM), [&] {
    out.loadArgument(0);
    out.ifEqual(0, kAllow);
    out.ifEqual(static_cast<std::uint32_t>(self), kAllow);
    out.ifEqual(static_cast<std::uint32_t>(-self), kAllow);
  });
  limitToSelf(out, __NR_tgkill, 0, self);
  limitToSelf(out, __NR_rt_sigqueueinfo, 0, self);
  limitToSelf(out, __NR_rt_tgsigqueueinfo, 0, self);
  out.ifEqual(__NR_tkill, fails(EPERM));
}

// Refuses truncate(), and to open a file for reading with O_TRUNC, which empties it without a right to write.
void limitTruncation(FilterWriter& out) {
  const auto limit = [&out](std::uint32_t call, std::size_t flags) {
    out.forCall(call, kAllow, [&] {
      out.loadArgument(flags);
      out.mask(O_ACCMODE | O_TRUNC);
      out.ifEqual(O_TRUNC, fails(EPERM));
    });
  };
  limit(__NR_openat, 2);
#ifdef __NR_open
  limit(__NR_open, 1);
#endif
  out.ifEqual(__NR_truncate, fails(EPERM));
}

void limitPriorities(FilterWriter& out, pid_t self) {
  limitToSelf(out, __NR_prlimit64, 0, self);
  limitToSelf(out, __NR_sched_setaffinity, 0, self);
  limitToSelf(out, __NR_sched_setparam, 0, self);
  limitToSelf(out, __NR_sched_setscheduler, 0, self);
  limitToSelf(out, __NR_sched_setattr, 0, self);
  // The id 0 also stands for the caller's process group or user, so only a process's priority may be set.
  const auto limit = [&](std::uint32_t call, std::uint32_t which) {
    out.forCall(call, fails(EPERM), [&] {
      out.loadArgument(1);
      out.forCall(0, fails(EPERM), [&] {
        out.loadArgument(0);
        out.ifEqual(which, kAllow);
      });
      out.forCall(static_cast<std::uint32_t>(self), fails(EPERM), [&] {
        out.loadArgument(0);
        out.ifEqual(which, kAllow);
      });
    });
  };
  limit(__NR_setpriority, PRIO_PROCESS);
  limit(__NR_ioprio_set, 1);  // IOPRIO_WHO_PROCESS
}

void limitArguments(FilterWriter& out) {
  out.forCall(__NR_clone, kAllow, [&] {
    out.loadArgument(0);
    out.ifAnyOf(kNewNamespaces, fails(EPERM));
  });
  // Refuses other pairs, because those of datagram sockets could send to any named socket of this machine.
  out.forCall(__NR_socketpair, fails(EPERM), [&] {
    out.loadArgument(1);
    out.mask(0xF);
    out.ifEqual(SOCK_STREAM, kAllow);
    out.ifEqual(SOCK_SEQPACKET, kAllow);
  });
  out.forCall(__NR_ioctl, kAllow, [&] {
    out.loadArgument(1);
    for (const std::uint32_t control : kRefusedControls) out.ifEqual(control, fails(EPERM));
    for (const std::uint32_t control : kRefusedFileControls) out.ifEqual(control, fails(EPERM));
  });
  // Refuses signals on events to other processes, and leases, which delay other processes that open the file.
  out.forCall(__NR_fcntl, kAllow, [&] {
    out.loadArgument(1);
    out.ifEqual(F_SETOWN, fails(EPERM));
    out.ifEqual(15, fails(EPERM));  // F_SETOWN_EX
    out.ifEqual(F_SETLEASE, fails(EPERM));
  });
  // Refuses options with which the world could outlive its supervisor or hide from it.
  out.forCall(__NR_prctl, kAllow, [&] {
    out.loadArgument(0);
    out.forCall(PR_SET_PDEATHSIG, fails(EPERM), [&] {
      out.loadArgument(1);
      out.ifEqual(SIGKILL, kAllow);
    });
    out.forCall(PR_SET_DUMPABLE, fails(EPERM), [&] {
      out.loadArgument(1);
      out.ifEqual(1, kAllow);
    });
  });
  // Refuses to change the times of a file by its path. Those of an open file may be changed.
  out.forCall(__NR_utimensat, fails(EPERM), [&] {
    out.loadArgument(1);
    out.forCall(0, fails(EPERM), [&] {
      out.loadArgumentHigh(1);
      out.ifEqual(0, kAllow);
    });
  });
}

#endif  // NAIAD_AUDIT_ARCH

}  // namespace

#ifdef NAIAD_AUDIT_ARCH

std::vector<sock_filter> makeSystemCallFilter(const FilterScene& scene) {
  FilterWriter out;
  out.load(offsetof(seccomp_data, arch));
  out.ifOther(NAIAD_AUDIT_ARCH, fails(EPERM));
  out.loadNumber();
#ifdef __x86_64__
  out.ifAtLeast(kX32, fails(EPERM));
#endif
  for (const std::uint32_t call : kRefused) out.ifEqual(call, fails(EPERM));
  if (!scene.traces_itself) out.ifEqual(__NR_ptrace, fails(EPERM));
  out.ifEqual(kClone3, fails(ENOSYS));  // a filter cannot read the arguments of these two calls
  out.ifEqual(kOpenat2, fails(ENOSYS));
  out.ifAtLeast(kFirstUnknown, fails(ENOSYS));
  limitArguments(out);
  limitPriorities(out, scene.self);
  if (!scene.signals_scoped) limitSignals(out, scene.self);
  if (!scene.truncation_held) limitTruncation(out);
  out.end(kAllow);
  return out.releaseCode();
}

#else

std::vector<sock_filter> makeSystemCallFilter(const FilterScene& /*scene*/) {
  return {};
}

#endif  // NAIAD_AUDIT_ARCH

int installSystemCallFilter(std::vector<sock_filter> filter) {
  if (filter.empty()) return ENOSYS;
  const sock_fprog program{static_cast<unsigned short>(filter.size()), filter.data()};
  // Does not use seccomp(), because systemd's usual list of calls does not allow it to services.
  return prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0 ? 0 : errno;
}

}  // namespace naiad
