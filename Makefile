# A fresh clone needs only Linux (x86-64), Python >= 3.11, pip and make: `make demo` or `make test` sets everything up.
PYTHON ?= python3
BIN := .venv/bin
# One line says how far pip is.
PIP := $(BIN)/python -I grader/tools/pip_progress.py --constraint constraints.txt

# Tests side by side: domains, partitions and folders are reserved by each worker.
# `exec`, so that whatever ends make ends the test run: the shell between them would not pass a signal on.
WORKERS ?= 4
PARALLEL := --numprocesses $(WORKERS) --dist worksteal

# Hundreds of Pythons are started: they find the modules compiled, whatever the caller's environment says.
export PYTHONDONTWRITEBYTECODE =
COMPILE := $(BIN)/python -m compileall -q sim grader public

# A chapter that was run is no change to git (.gitattributes); where there is no git, there is nothing to do.
FILTER := ! git rev-parse --git-dir >/dev/null 2>&1 || \
    git config filter.notebook-outputs.clean 'python3 -I -S grader/tools/notebook_outputs.py'

# Where a student works: chapters and exercises, without solutions and grader. Authors: `make chapters MINE=.`
MINE ?= my_course

.PHONY: setup chapters my-course update demo test verify prove-exercises prove-long attacks pythons prove-determinism soak bench fidelity explained book fuzz worlds lint clean
setup: .venv/with-course

.venv/with-course: pyproject.toml constraints.txt
	@$(PYTHON) -I sim/machine.py
	$(PYTHON) -m venv .venv
	$(PIP) --editable .
	@$(FILTER)
	@touch $@

.venv/with-chapters: .venv/with-course
	$(PIP) --editable '.[chapters]'
	@touch $@

.venv/with-tools: .venv/with-course
	$(PIP) --editable '.[dev]'
	@touch $@

# Opens JupyterLab where its file list shows chapters/ and exercises/, and nothing else.
chapters: .venv/with-chapters my-course
	PATH="$(CURDIR)/$(BIN):$$PATH" exec $(BIN)/jupyter lab $(JUPYTER_OPTIONS) \
	    "$(MINE)/chapters/00_first_run/00_first_run.ipynb" --ServerApp.root_dir="$(abspath $(MINE))" \
	    --FileContentsManager.post_save_hook=gz_course.grader.tools.notebook_outputs.after_save

my-course: .venv/with-course
	@$(FILTER)
	@$(BIN)/python -m gz_course.grader.course_folder.in_clone "$(MINE)"

# The newest version of the course. Your own files in my_course stay; changes of the clone are set aside and come back.
update:
	git pull --quiet --rebase --autostash
	@$(MAKE) --no-print-directory setup my-course
	@echo "The course is up to date; CHANGELOG.md says what is new."

demo: setup
	@$(BIN)/course grade 03_teleop --submission solutions/03_teleop --out runs/demo
	@$(BIN)/course grade 04_lidar_listener --submission solutions/04_lidar_listener --out runs/demo
	@echo
	@echo "Look into a recording: $(BIN)/course show runs/demo/03_teleop.rrd"
	@$(BIN)/python -m gz_course.grader.report.browser runs/demo/04_lidar_listener.html

test: .venv/with-tools
	@$(COMPILE)
	exec $(BIN)/pytest -q -m "not proof" $(PYTEST_OPTIONS) $(PARALLEL)

verify: .venv/with-tools
	@$(COMPILE)
	$(MAKE) --no-print-directory prove-exercises prove-long attacks pythons PYTHONS_OPTIONS=--others

prove-exercises: .venv/with-tools
	exec $(BIN)/course verify
prove-long: .venv/with-tools
	exec $(BIN)/pytest -q -m "proof or hypothesis" --hypothesis-profile=all_examples --ignore=tests/hostile \
	    $(PYTEST_OPTIONS) $(PARALLEL)
attacks: .venv/with-tools
	exec $(BIN)/pytest -q tests/hostile $(PYTEST_OPTIONS) $(PARALLEL)

# What is committed, on each Python from 3.11 to 3.14 that this machine has: the suite, or the demo and all solutions.
pythons: .venv/with-tools
	exec $(BIN)/python -m gz_course.tests.pythons $(PYTHONS_OPTIONS)

# The same submission, graded often, half of the times on a busy machine: one score, one trajectory.
GRADINGS ?= 200
prove-determinism: .venv/with-tools
	exec $(BIN)/python -m gz_course.tests.determinism $(GRADINGS)

# Scenes here, in DART and in Gazebo's own physics (WORDS choose some; FIDELITY_OPTIONS=--record keeps what those gave).
fidelity: .venv/with-tools
	exec $(BIN)/python -m gz_course.tests.conformance.physics $(FIDELITY_OPTIONS) $(WORDS)

# What `course explain` finds for each rejected variant, beside what is known of it: make explained WORDS=03_teleop
explained: .venv/with-tools
	exec $(BIN)/python -m gz_course.tests.explained $(WORDS)

# Long runs: MINUTES of simulated time of a world with its bridge and three nodes, and a class of STUDENTS.
MINUTES ?= 60
STUDENTS ?= 500
soak: .venv/with-tools
	exec $(BIN)/python -m gz_course.tests.soak --minutes $(MINUTES) --students $(STUDENTS) $(SOAK_OPTIONS)

# Worlds of a folder, such as a checkout of gz-sim 8, against the table of what they do here: make worlds DIR=../gz-sim
worlds: .venv/with-tools
	@test -n "$(DIR)" || { echo "make worlds DIR=FOLDER: which folder of worlds?"; exit 2; }
	exec $(BIN)/python -m gz_course.tests.worlds "$(DIR)" $(WORLDS_OPTIONS)

bench: .venv/with-tools
	$(BIN)/python -m gz_course.tests.bench

book: .venv/with-tools
	$(BIN)/python -m gz_course.grader.tools.book build/book

fuzz: .venv/with-tools
	$(BIN)/python -m gz_course.tests.fuzz.load_worlds
	exec $(BIN)/pytest -q -m "not proof" --hypothesis-profile=new_examples $(PARALLEL)

lint: .venv/with-tools
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

# Not `runs`: it holds scores and the files that `course reset` has kept.
clean:
	rm -rf .venv build dist .mypy_cache .ruff_cache .pytest_cache .hypothesis
