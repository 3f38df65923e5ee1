# The course in a container, for Linux on x86-64 (on a Mac or Windows: docs/windows_and_mac.md).
#
#   docker build --platform linux/amd64 -t gz-ros2-course .
#   docker run --rm -p 127.0.0.1:8888:8888 -v "$PWD/my_course:/home/student/my_course" gz-ros2-course
#
# It runs as an ordinary user and needs no network. `--target grader` is the same without JupyterLab and viewers:
#
#   docker run --rm --network none -v "$PWD:/work:ro" grader course grade 03_teleop --submission /work/teleop_node.py

FROM python:3.11-slim-bookworm AS wheel
WORKDIR /source
COPY . .
RUN pip wheel --no-cache-dir --no-deps --wheel-dir /wheels .

FROM python:3.11-slim-bookworm AS environment
COPY --from=wheel /wheels /wheels
COPY constraints.txt /wheels/
RUN python -m venv /opt/course \
    && /opt/course/bin/pip install --no-cache-dir --constraint /wheels/constraints.txt /wheels/*.whl

FROM environment AS environment-for-grading
RUN /opt/course/bin/python -m gz_course.grader.tools.slim \
    && /opt/course/bin/pip uninstall --quiet --yes pip setuptools

FROM environment AS environment-with-jupyter
RUN /opt/course/bin/pip install --no-cache-dir --constraint /wheels/constraints.txt 'gz-ros2-course[hub]'

FROM python:3.11-slim-bookworm AS user
RUN useradd --create-home --uid 1000 --shell /bin/bash student
ENV PATH=/opt/course/bin:$PATH \
    LANG=C.UTF-8
USER 1000:1000
WORKDIR /home/student

FROM user AS grader
COPY --from=environment-for-grading /opt/course /opt/course
RUN course init my_course
WORKDIR /home/student/my_course
CMD ["course", "list"]

FROM user AS course
COPY --from=environment-with-jupyter /opt/course /opt/course
RUN course init my_course
WORKDIR /home/student/my_course
# The live view comes through JupyterLab's port.
ENV COURSE_PROXY=/
EXPOSE 8888
CMD ["jupyter", "lab", "--ip=0.0.0.0", "--port=8888", "--no-browser"]
