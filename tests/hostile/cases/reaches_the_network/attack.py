import os
import socket


def attempt(what, call):
    try:
        call()
    except OSError as error:
        print("held", what, os.strerror(error.errno) if error.errno and error.errno > 0 else error, flush=True)
    else:
        print("ESCAPED", what, flush=True)


def tcp(address, family=socket.AF_INET):
    with socket.socket(family) as some:
        some.settimeout(3)
        some.connect(address)


def udp(address):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as some:
        some.sendto(b"secret", address)


attempt("tcp", lambda: tcp(("1.1.1.1", 80)))
attempt("tcp6", lambda: tcp(("2606:4700:4700::1111", 80), socket.AF_INET6))
attempt("udp", lambda: udp(("8.8.8.8", 53)))
attempt("broadcast", lambda: udp(("192.168.1.255", 9)))
attempt("names", lambda: socket.getaddrinfo("example.org", 80))
attempt("packet", lambda: socket.socket(socket.AF_PACKET, socket.SOCK_RAW))
attempt("raw", lambda: socket.socket(socket.AF_INET, socket.SOCK_RAW, socket.IPPROTO_ICMP))
attempt("vsock", lambda: socket.socket(socket.AF_VSOCK, socket.SOCK_STREAM).connect((2, 1)))
others = {name for _, name in socket.if_nameindex()} - {"lo"}
print("ESCAPED" if others else "held", "interfaces", others, flush=True)
# The grader's reservation of its ROS domain: nobody listens there.
abstract = [line for line in open("/proc/net/unix") if "@" in line and "@gz-ros2-course-domain" not in line]
print("ESCAPED" if abstract else "held", "abstract sockets", abstract, flush=True)
with open("/proc/net/tcp") as table:
    listening = len(table.readlines()) - 1
print("ESCAPED" if listening else "held", "tcp listeners", listening, flush=True)
