#!/bin/sh
# playground_long.sh: what else playground.mjs tests: all examples, files that are downloaded, axe's rules, phones, large texts, times without a
# network, a hundred random actions.
KRS_ACTIONS=100 KRS_PARTS="layout stop words downloads access phones large offline actions fault examples" exec "$(dirname "$0")/playground.sh"
