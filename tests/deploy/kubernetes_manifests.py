#!/usr/bin/env python3
"""The manifests of deploy/kubernetes against the schema of Kubernetes, as its Python client has it, and against what
they refer to. Prints each fault; exits 1 where there are any.

  kubernetes_manifests.py FOLDER OPENAPI GUIDE

OPENAPI describes the routes of the daemon, GUIDE the commands that make what the manifests name.
"""
import json
import pathlib
import sys

import yaml
from kubernetes import client

folder, openapi, guide = map(pathlib.Path, sys.argv[1:])
API = client.ApiClient()
routes = json.loads(openapi.read_text())["paths"]
commands = guide.read_text()
faults = []


class Answer:
    """What the client reads objects from."""

    def __init__(self, document):
        self.data = json.dumps(document)


def model_of(document):
    """The class of the schema: apps/v1 Deployment is V1Deployment."""
    return f"V1{document['kind']}" if document["apiVersion"].split("/")[-1] == "v1" else document["kind"]


def differences(given, known, where):
    """What the schema does not know of, or knows as something else."""
    if isinstance(given, dict) and isinstance(known, dict):
        return [fault for key, value in given.items()
                for fault in (differences(value, known[key], f"{where}.{key}") if key in known
                              else [f"{where}.{key} is not of the schema"] if value not in ({}, []) else [])]
    if isinstance(given, list) and isinstance(known, list) and len(given) == len(known):
        return [fault for index, pair in enumerate(zip(given, known)) for fault in differences(*pair, f"{where}[{index}]")]
    same = type(given) is type(known) and given == known
    return [] if same else [f"{where} is {given!r}, and the schema makes {known!r} of it"]


def check(condition, fault):
    if not condition:
        faults.append(fault)


def keeps_to_schema(document, name):
    before = len(faults)
    try:
        known = API.sanitize_for_serialization(API.deserialize(Answer(document), model_of(document)))
    except (ValueError, AttributeError, TypeError) as error:  # what is required and missing
        faults.append(f"{name}: {error}")
    else:
        faults.extend(differences(document, known, name))
    return len(faults) == before


def check_workload(document, name):
    template = document["spec"]["template"]
    check(document["spec"]["selector"]["matchLabels"] == template["metadata"]["labels"], f"{name} does not select its pods")
    volumes = {volume["name"]: volume for volume in template["spec"]["volumes"]}
    for container in template["spec"]["containers"]:
        for mount in container["volumeMounts"]:
            check(mount["name"] in volumes, f"{name} mounts {mount['name']}, which is no volume")
        for probe in ("startupProbe", "readinessProbe", "livenessProbe"):
            path = container.get(probe, {}).get("httpGet", {}).get("path")
            check(path is None or path in routes, f"{name}: {probe} asks for {path}, which is no route of the daemon")
        for variable in container["env"]:
            reference = variable.get("valueFrom", {}).get("secretKeyRef", {})
            if reference:
                made = f"secret generic {reference['name']}" in commands and f"{reference['key']}=" in commands
                check(made, f"{name}: nothing in {guide.name} makes {reference['key']} of {reference['name']}")
            value = variable.get("value", "")
            check("/" not in value or any(mount["mountPath"] in value for mount in container["volumeMounts"]),
                  f"{name}: {variable['name']} names a file that nothing mounts")
    for volume in volumes.values():
        made = volume.get("configMap", {}).get("name") or volume.get("secret", {}).get("secretName")
        check(made is None or f" {made} " in commands, f"{name}: nothing in {guide.name} makes {made}")


documents = [(f"{file.name} {document['kind']}", document) for file in sorted(folder.glob("*.yaml"))
             for document in yaml.safe_load_all(file.read_text())]
workloads = {}
for name, document in documents:
    if keeps_to_schema(document, name) and "template" in document.get("spec", {}):
        check_workload(document, name)
        workloads[name] = document["spec"]["template"]["metadata"]["labels"]
for name, document in documents:
    selector = document.get("spec", {}).get("selector") or document.get("spec", {}).get("podSelector")
    if document["kind"] in ("PodDisruptionBudget", "NetworkPolicy", "Service") and selector:
        check(selector.get("matchLabels", selector) in workloads.values(), f"{name} selects no pods")
print(*faults, sep="\n", end="\n" if faults else "")
print(f"{len(documents)} objects, {len(faults)} faults")
sys.exit(bool(faults))
