#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The Parkade authors
# SPDX-License-Identifier: Apache-2.0
#
# Installs the Debian 12 packages that Parkade is built from. Asks apt nothing when all are there;
# asks the user nothing ever.
# Usage: tools/install_deps.sh [--ci] [--list]
#   --ci     also what CI alone needs
#   --list   only print the packages
set -euo pipefail

packages=(
  # to build
  build-essential cmake git ninja-build pkg-config
  # the program
  libceres-dev libcli11-dev libcpp-httplib-dev libdnnl-dev libeigen3-dev libembree-dev libfmt-dev
  libonnx-dev libopencv-dev libprotobuf-dev libspdlog-dev libsqlite3-dev libturbojpeg0-dev libyaml-cpp-dev
  libzstd-dev nlohmann-json3-dev ocl-icd-opencl-dev
  # to test and to measure
  libbenchmark-dev libgmock-dev libgtest-dev python3 python3-numpy python3-pil
  python3-yaml
)
# Only CI needs these.
ci_packages=(clang-format)

usage="usage: tools/install_deps.sh [--ci] [--list]"
ci=false
list=false
for argument in "$@"; do
  case "$argument" in
    --ci) ci=true ;;
    --list) list=true ;;
    -h | --help)
      echo "$usage"
      exit 0
      ;;
    *)
      echo "install_deps: unknown argument: $argument" >&2
      echo "$usage" >&2
      exit 2
      ;;
  esac
done
if $ci; then
  packages+=("${ci_packages[@]}")
fi
if $list; then
  printf '%s\n' "${packages[@]}"
  exit 0
fi

missing=()
for package in "${packages[@]}"; do
  status=$(dpkg-query -W -f='${db:Status-Abbrev}' "$package" 2>/dev/null || true)
  [[ "$status" == ii* ]] || missing+=("$package")
done
if [ ${#missing[@]} -eq 0 ]; then
  exit 0
fi

echo "Installing ${#missing[@]} Debian packages: ${missing[*]}"
sudo=()
if [ "$(id -u)" -ne 0 ]; then
  if ! command -v sudo >/dev/null; then
    echo "These packages are missing, and installing them needs root: apt-get install ${missing[*]}" >&2
    exit 1
  fi
  sudo=(sudo)
fi
export DEBIAN_FRONTEND=noninteractive
"${sudo[@]}" apt-get update -q
"${sudo[@]}" env DEBIAN_FRONTEND=noninteractive \
  apt-get install -q -y --no-install-recommends "${missing[@]}"
