#!/bin/sh
# Renders the references that the tests compare with: references/SCENE-TRANSPORT.exr, 64×36.
#
#     ./make_references.sh FOLDER [SCENE …]
#
# FOLDER holds SCENE.glb and, where the scene has one, its environment SCENE.exr, as
# `aquifer scenes export SCENE FOLDER/SCENE.glb` writes them; `lamps` is one of held_out_scenes.py, kept as references/lamps.glb.
# A reference that shows the same .glb is left alone. PYTHON names the interpreter.
set -eu
folder=$(cd "$1" && pwd)
shift
[ $# -gt 0 ] || set -- cornell glossy door_ajar sun_room textured outdoor lamps
cd "$(dirname "$0")"
mkdir -p references
for scene in "$@"; do
    environment=
    [ ! -e "$folder/$scene.exr" ] || environment="--environment $folder/$scene.exr"
    glb=$folder/$scene.glb
    case $scene in
    lamps)
        glb=references/lamps.glb
        transports=direct
        "${PYTHON:-python3}" held_out_scenes.py references lamps
        ;;
    cornell | glossy) transports='direct indirect:2 full:4' ;;
    *) transports='direct full:2' ;;
    esac
    # Where light comes through a slit, four times the samples; what that leaves of error, 0.4 %, both renderers together can bear.
    spp=262144 target=0.003
    [ "$scene" != door_ajar ] || spp=1048576 target=0.004
    for transport in $transports; do
        output=references/$scene-$(echo "$transport" | tr -d :).exr
        # shellcheck disable=SC2086 # the option and its value are two words
        "${PYTHON:-python3}" render.py "$glb" $environment --transport "$transport" --size 64x36 \
            --spp "$spp" --batches 8192 --target "$target" --keep -o "$output"
    done
done
