#!/usr/bin/env bash
# Builds the images of docs/cluster by buildah and Apptainer, and runs the program in them by podman and Apptainer.
#
#   sudo tests/container.sh            # about ten minutes; not part of test.sh
#
# Needs root, Debian's buildah, podman, runc and debootstrap, rustup with the target *-linux-musl, and packages of
# Debian and Rust. No registry of images is asked: images of the names that the recipes begin with are made of
# Debian's packages and this computer's Rust, in a folder of their own, and so is Apptainer, which is in Debian's
# `sid`. ALEWIFE_CONTAINER_ROOT is a folder in which all of this is kept for the next time.
set -euo pipefail

source=$(cd "$(dirname "$0")/.." && pwd)
. "$source/tests/batch.sh"
temporary=$(mktemp -d "${TMPDIR:-/tmp}/alewife-container.XXXXXX")
place=${ALEWIFE_CONTAINER_ROOT:-$temporary}
storage=(--root "$place/storage" --runroot "$place/run")
rust=docker.io/library/rust:1.95-bookworm
busybox=docker.io/library/busybox:musl
# Whose numbers no file of this computer has
user=54321

clean_up() {
    podman "${storage[@]}" rm --all --force >/dev/null 2>&1 || true
    [ "$place" != "$temporary" ] || buildah "${storage[@]}" rmi --all --force >/dev/null 2>&1 || true
    rm -rf --one-file-system "$temporary"
}
trap clean_up EXIT
trap 'exit 130' INT TERM

# NAME, what was found, and what was to be.
is() { [ "$2" = "$3" ] && row "$1" 0 "$2" || row "$1" 1 "$2 instead of $3"; }

# What a recipe keeps for the next build stays here, too
build() { TMPDIR=$place/tmp buildah "${storage[@]}" "$@"; }

# A folder with packages of a suite of Debian: SUITE PACKAGES FOLDER.
debian() {
    [ ! -e "$3/complete" ] || return 0
    echo "installing $2 of $1 ..."
    debootstrap --variant=minbase --include="$2" "$1" "$3" >"$temporary/install.log" 2>&1 ||
        { tail -5 "$temporary/install.log" >&2; exit 2; }
    # Of a computer whose packages come through a proxy
    cp /etc/ssl/certs/ca-certificates.crt "$3/etc/ssl/certs/" 2>/dev/null || true
    touch "$3/complete"
}

# --- Images ---------------------------------------------------------------------------------------

# An image of a folder: FOLDER NAME, and what it is configured with.
image_of() {
    local folder=$1 name=$2 container
    shift 2
    container=$(build from scratch)
    tar -C "$folder" --exclude='./proc/*' --exclude='./sys/*' --exclude='./dev/*' -cf - . |
        tar -C "$(build mount "$container")" -xpf -
    build config "$@" "$container"
    build commit --quiet --rm "$container" "$name" >/dev/null
}

has_image() { build inspect --type image "$1" >/dev/null 2>&1; }

base_images() {
    local root=$place/bookworm toolchain
    ! has_image "$busybox" || ! has_image "$rust" || return 0
    debian bookworm gcc,libc6-dev,ca-certificates,busybox-static "$root"
    mkdir -p "$place/busybox/bin" "$place/busybox/tmp" "$place/busybox/etc"
    cp "$root/bin/busybox" "$place/busybox/bin/busybox"
    chroot "$place/busybox" /bin/busybox --install -s /bin
    has_image "$busybox" || image_of "$place/busybox" "$busybox" --cmd sh
    has_image "$rust" && return
    toolchain=$(rustc --print sysroot)
    mkdir -p "$root/usr/local/cargo/bin" "$root/usr/local/rustup/toolchains"
    cp -L "$(command -v rustup)" "$root/usr/local/cargo/bin/rustup"
    for name in cargo rustc; do ln -sf rustup "$root/usr/local/cargo/bin/$name"; done
    tar -C "$(dirname "$toolchain")" --exclude='*/share/doc' -cf - "$(basename "$toolchain")" |
        tar -C "$root/usr/local/rustup/toolchains" -xpf -
    echo "default_toolchain = \"$(basename "$toolchain")\"" >"$root/usr/local/rustup/settings.toml"
    image_of "$root" "$rust" --env RUSTUP_HOME=/usr/local/rustup --env CARGO_HOME=/usr/local/cargo \
        --env PATH=/usr/local/cargo/bin:/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin
}

docker_image() {
    local before after
    before=$(cd "$source" && git status --porcelain)
    # Isolation by chroot needs the least of this computer
    build bud --isolation chroot --pull-never --layers --file "$source/docs/cluster/Dockerfile" \
        --build-arg GIT="$(git -C "$source" describe --always)" --tag localhost/alewife "$source" \
        >"$temporary/build.log" 2>&1 || { tail -20 "$temporary/build.log" >&2; exit 1; }
    after=$(cd "$source" && git status --porcelain)
    [ "$after" = "$before" ] && row "Dockerfile: builds, and leaves the source as it was" 0 ||
        row "Dockerfile: builds, and leaves the source as it was" 1 "$after"
    local size
    size=$(podman "${storage[@]}" image inspect --format '{{.Size}}' localhost/alewife)
    [ "$size" -lt 50000000 ] && row "Dockerfile: an image of less than 50 MB" 0 "$size bytes" ||
        row "Dockerfile: an image of less than 50 MB" 1 "$size bytes"
    local label="{{index .Config.Labels \"org.opencontainers.image.revision\"}}"
    is "Dockerfile: the image knows its source" \
        "$(podman "${storage[@]}" image inspect --format "$label" localhost/alewife)" \
        "$(git -C "$source" describe --always)"
}

# --- Runs by podman -------------------------------------------------------------------------------

# OPTIONS IMAGE COMMAND in a container that has nothing but what it is given.
contained() {
    podman "${storage[@]}" --runtime runc --cgroup-manager cgroupfs run --network none --read-only --cap-drop all \
        --ulimit nofile=1024:1024 --ulimit nproc=4096:4096 "$@"
}

alone() { contained --rm --log-driver none "$@"; }

# Runs as somebody with a folder of his.
his() { alone --user "$user:$user" --volume "$data:/data" localhost/alewife "$@"; }

# Starts NAME as his run and waits for a checkpoint, then lets a command stop it; tells how it ended.
stopped_by() {
    local name=$1 waited=0
    shift
    contained --detach --name "$name" --user "$user:$user" --volume "$data:/data" localhost/alewife \
        run long.toml --threads 1 >/dev/null
    until compgen -G "$data/runs/long/checkpoints/*.state" >/dev/null || [ "$waited" -ge 120 ]; do
        sleep 0.5
        waited=$((waited + 1))
    done
    podman "${storage[@]}" "$@" "$name" >/dev/null
    podman "${storage[@]}" wait "$name"
    podman "${storage[@]}" rm "$name" >/dev/null
}

by_podman() {
    local told code=0
    is "podman: --version" "$(alone localhost/alewife --version)" "$version"
    his run squirmer-alone --quiet >"$temporary/log" 2>&1 || code=$?
    is "podman: a run as somebody, in a folder of his" \
        "$code $(stat -c %u "$data/runs/squirmer-alone/status.json" 2>/dev/null)" "0 $user"
    his sweep run squirmer-alone --quiet >"$temporary/log" 2>&1 && row "podman: a sweep, by processes of its own" 0 ||
        row "podman: a sweep, by processes of its own" 1 "$(tail -2 "$temporary/log")"
    code=0
    alone --volume "$data:/data" localhost/alewife run squirmer-alone --out other >"$temporary/log" 2>&1 || code=$?
    is "podman: a folder of somebody else's is refused" "$code" 74
    told=$(cat "$temporary/log")
    case $told in
    *other*"ermission denied"*) row "podman: ... by its name" 0 "$told" ;;
    *) row "podman: ... by its name" 1 "$told" ;;
    esac
    code=0
    contained --rm --log-driver none --read-only=false localhost/alewife run squirmer-alone --quiet \
        >"$temporary/log" 2>&1 || code=$?
    is "podman: without a folder, in the container" "$code" 0
    is "podman: Ctrl-C ends a run with a checkpoint" "$(stopped_by first kill --signal INT)" 75
    is "podman: podman stop does, too" "$(stopped_by second stop --time 60)" 75
    code=0
    his run long.toml --threads 1 --quiet >"$temporary/log" 2>&1 || code=$?
    is "podman: it continues to its end" \
        "$code, resumed $(grep -c '"resumed"' "$data/runs/long/log.jsonl") times" "0, resumed 2 times"
    his run long.toml --out whole --threads 1 --quiet >"$temporary/log" 2>&1
    compare "podman: with the bits of an unbroken run" "$data/runs/long" "$data/whole"
}

# --- Apptainer ------------------------------------------------------------------------------------

# A command in the folder `job`, as somebody, where Apptainer is installed.
with_apptainer() {
    unshare --mount --pid --fork --kill-child bash -c '
        set -e
        root=$1
        mount --make-rprivate /
        # Namespaces inside want a root that is a mount of its own
        mount --bind "$root" "$root"
        mount --make-rprivate "$root"
        mount --rbind /dev "$root/dev"
        mount -t proc proc "$root/proc"
        mount -t sysfs -o ro sysfs "$root/sys"
        mount -t tmpfs tmpfs "$root/tmp"
        mkdir -p "$root/job" "$root/before"
        mount --bind "$2" "$root/job"
        cd "$root"
        pivot_root . before
        cd /job
        umount -l /before
        exec setpriv --reuid "$3" --regid "$3" --clear-groups env HOME=/job /bin/bash -c "$4"' \
        _ "$place/sid" "$job" "$user" "$1"
}

by_apptainer() {
    local container told
    job=$temporary/job
    mkdir -p "$job"
    # Without squashfuse, which wants /dev/fuse: images are unpacked before they are run
    debian sid apptainer "$place/sid"
    cp /etc/hosts /etc/resolv.conf "$place/sid/etc/"
    grep -q ":$user:" "$place/sid/etc/passwd" || chroot "$place/sid" useradd --uid "$user" --home-dir /job somebody
    # The image that the recipe begins with stands in a file, and the program is that of the Dockerfile
    build push --quiet "$busybox" "oci-archive:$job/busybox.tar" >/dev/null
    sed -e 's/^Bootstrap: .*/Bootstrap: oci-archive/' -e 's/^From: .*/From: busybox.tar/' \
        "$source/docs/cluster/alewife.def" >"$job/alewife.def"
    container=$(build from --pull-never localhost/alewife)
    cp "$(build mount "$container")/alewife" "$job/alewife"
    build rm "$container" >/dev/null
    cp "$data/long.toml" "$job/"
    chown -R "$user:$user" "$job"
    local name="Apptainer: builds as somebody, with %test"
    with_apptainer "apptainer build alewife.sif alewife.def" >"$temporary/log" 2>&1 && row "$name" 0 ||
        { row "$name" 1 "$(tail -3 "$temporary/log")"; return; }
    is "Apptainer: --version" "$(with_apptainer 'apptainer --quiet run alewife.sif --version' 2>/dev/null)" "$version"
    with_apptainer "apptainer --quiet test alewife.sif" >"$temporary/log" 2>&1 &&
        row "Apptainer: test" 0 "$(stat -c %s "$job/alewife.sif") bytes" ||
        row "Apptainer: test" 1 "$(tail -3 "$temporary/log")"
    # Stopped as Slurm does it, once there is a checkpoint
    told=$(with_apptainer '
        apptainer --quiet run alewife.sif run long.toml --threads 1 --quiet >/dev/null 2>&1 & run=$!
        for (( waited = 0; waited < 240; waited++ )); do
            if compgen -G "runs/long/checkpoints/*.state" >/dev/null; then break; fi
            sleep 0.5
        done
        kill -TERM $run
        code=0; wait $run || code=$?
        apptainer --quiet run alewife.sif run long.toml --threads 1 --quiet >/dev/null 2>&1
        echo "$code $?"' 2>"$temporary/log")
    is "Apptainer: SIGTERM ends a run with a checkpoint, it continues" "$told" "75 0"
    compare "Apptainer: with the bits of an unbroken run" "$job/runs/long" "$data/whole"
}

[ "$(id -u)" = 0 ] || { echo "error: run it as root" >&2; exit 2; }
for program in buildah podman runc debootstrap rustup; do
    command -v $program >/dev/null || { echo "error: $program is not installed" >&2; exit 2; }
done
data=$temporary/data
mkdir -p "$data" "$place/tmp"
case_file "$data/long.toml" 1.5 "$accurate"
chown -R "$user:$user" "$data"
chmod 711 "$temporary"
version="alewife $(sed -n 's/^version = "\(.*\)"/\1/p' "$source/Cargo.toml" | head -1)"
echo "$(buildah --version), $(podman --version)"
base_images
docker_image
by_podman
by_apptainer
tell_failures
