"""Talks to sockets that are not the submission's, takes their place, and asks the kernel for sockets of other kinds."""

import contextlib
import socket

PORTS = "/proc/net/udp"
VICTIMS_PORT = 7_999
CONNECTOR = 11  # a protocol of netlink


def own_sockets():
    """The inodes of the sockets of this process."""
    found = set()
    for number in os.listdir("/proc/self/fd"):
        with contextlib.suppress(OSError):
            found.add(os.readlink(f"/proc/self/fd/{number}").removeprefix("socket:[").rstrip("]"))
    return found


def bound():
    """The UDP ports of this network that somebody else has."""
    with open(PORTS) as table:
        rows = [line.split() for line in table.readlines()[1:]]
    return {int(row[1].rpartition(":")[2], 16) for row in rows if row[9] not in own_sockets()}


def abstract_names():
    """Names of abstract sockets, but for the grader's reservation of a ROS domain, where nobody listens."""
    with open("/proc/net/unix") as table:
        rows = [line.split() for line in table]
    names = {row[7][1:] for row in rows if len(row) > 7 and row[7].startswith("@")}
    return sorted(name for name in names if not name.startswith("gz-ros2-course-domain"))[:20]


def connected(name):
    for kind in (socket.SOCK_STREAM, socket.SOCK_SEQPACKET, socket.SOCK_DGRAM):
        with contextlib.suppress(OSError), socket.socket(socket.AF_UNIX, kind) as door:
            door.settimeout(1)
            door.connect("\0" + name)
            return True
    return False


def taken(port):
    """Whether the port of somebody else can be had, too: datagrams for it would come here."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as thief:
        thief.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        thief.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEPORT, 1)
        thief.bind(("127.0.0.1", port))
        thief.settimeout(1)
        for _ in range(50):  # senders: the kernel deals them out among those who have the port
            with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
                sender.sendto(b"x", ("127.0.0.1", port))
        return thief.recv(1)


def asked(protocol, kind, body, flags=5):
    """Send a request of netlink; whether the kernel has carried it out (NLMSG_ERROR with 0)."""
    with socket.socket(socket.AF_NETLINK, socket.SOCK_RAW, protocol) as kernel:
        kernel.settimeout(1)
        kernel.bind((0, 0))
        kernel.send(struct.pack("IHHII", 16 + len(body), kind, flags, 1, 0) + body)
        answer = kernel.recv(4096)
        return struct.unpack_from("H", answer, 4)[0] == 2 and struct.unpack_from("i", answer, 16)[0] == 0


def heard(protocol, group):
    """Whether the kernel tells of what others do: here, that a process has started and ended."""
    with socket.socket(socket.AF_NETLINK, socket.SOCK_DGRAM, protocol) as kernel:
        kernel.bind((os.getpid(), group))
        kernel.settimeout(1)
        if protocol == CONNECTOR:
            wish = struct.pack("IIIIHHI", 1, 1, 0, 0, 4, 0, 1)  # of the events of processes: listen
            kernel.send(struct.pack("IHHII", 16 + len(wish), 3, 0, 0, os.getpid()) + wish)
        if (child := os.fork()) == 0:
            os._exit(0)
        os.waitpid(child, 0)
        return kernel.recv(4096)


def made(family, kind, protocol):
    with socket.socket(family, kind, protocol):
        return True


def option(level, name, value, family=socket.AF_INET):
    with socket.socket(family, socket.SOCK_DGRAM) as some:
        return some.setsockopt(level, name, value) is None


names = abstract_names()
attempt(f"abstract sockets {names}", lambda: [name for name in names if connected(name)] or None)
ports = [VICTIMS_PORT] if VICTIM else sorted(bound())
attempt(f"ports of others {ports}", lambda: [port for port in ports if attempt(f"port {port}", lambda: taken(port))] or None)
attempt("loopback down", lambda: asked(0, 16, struct.pack("BxHiII", 0, 0, 1, 0, 0)))
attempt("a new address", lambda: asked(0, 20, struct.pack("BBBBI", 2, 8, 0, 254, 1) + struct.pack("HH4B", 8, 2, 10, 9, 8, 7), 0x405))
attempt("a new route", lambda: asked(0, 24, struct.pack("8BI", 2, 8, 0, 0, 254, 3, 253, 1, 0) + struct.pack("HH4BHHi", 8, 1, 10, 0, 0, 0, 8, 4, 1), 0x405))
attempt("processes as they start", lambda: heard(CONNECTOR, 1))
attempt("the audit log", lambda: heard(9, 1))
attempt("a mark on packets", lambda: option(socket.SOL_SOCKET, 36, 1))
attempt("the address of somebody else", lambda: option(socket.SOL_IP, 19, 1))
attempt("a larger buffer", lambda: option(socket.SOL_SOCKET, 33, 1 << 28))
attempt("a high priority", lambda: option(socket.SOL_SOCKET, socket.SO_PRIORITY, 7))
for name, family, kind, protocol in (
    ("packet", 17, socket.SOCK_RAW, 0),
    ("vsock", 40, socket.SOCK_STREAM, 0),
    ("xdp", 44, socket.SOCK_RAW, 0),
    ("raw", 2, socket.SOCK_RAW, 1),
    ("key", 15, socket.SOCK_RAW, 2),
    ("alg", 38, socket.SOCK_SEQPACKET, 0),
):
    attempt(f"a socket of the kind {name}", lambda: made(family, kind, protocol))
