"""Checks a Job of Kubernetes: kubernetes_job.py FILE FOLDER PICTURES COMPLETIONS.

The schema is that of batch/v1 as the reference of Kubernetes 1.33 has it, of the fields that are used here.  Faults are planted
in the file, and each has to be found.
"""
import copy
import sys

import jsonschema
import yaml

path, folder, pictures, completions = sys.argv[1:]
PATH = {'type': 'string', 'pattern': '^/[^:]*$'}
NAME = {'type': 'string', 'pattern': '^[a-z0-9]([-a-z0-9]*[a-z0-9])?$', 'maxLength': 63}


def fields(required, optional=None):
    return {'type': 'object', 'properties': {**required, **(optional or {})}, 'required': list(required),
            'additionalProperties': False}


RULE = fields({'action': {'enum': ['FailJob', 'FailIndex', 'Ignore', 'Count']},
               'onExitCodes': fields({'operator': {'enum': ['In', 'NotIn']},
                                      'values': {'type': 'array', 'minItems': 1, 'maxItems': 255, 'uniqueItems': True,
                                                 'items': {'type': 'integer', 'minimum': 1, 'maximum': 255}}},
                                     {'containerName': NAME})})
CONTAINER = fields({'name': NAME, 'image': {'type': 'string', 'minLength': 1},
                    'command': {'type': 'array', 'items': {'type': 'string'}},
                    'volumeMounts': {'type': 'array', 'items': fields({'name': NAME, 'mountPath': PATH})}})
VOLUME = fields({'name': NAME, 'hostPath': fields({'path': PATH, 'type': {'enum': ['Directory', 'DirectoryOrCreate']}})})
POD = fields({'restartPolicy': {'const': 'Never'},  # podFailurePolicy and backoffLimitPerIndex need it
              'containers': {'type': 'array', 'minItems': 1, 'items': CONTAINER},
              'volumes': {'type': 'array', 'items': VOLUME}},
             {'terminationGracePeriodSeconds': {'type': 'integer', 'minimum': 0}})
JOB = fields({'apiVersion': {'const': 'batch/v1'}, 'kind': {'const': 'Job'}, 'metadata': fields({'name': NAME}),
              'spec': fields({'completionMode': {'const': 'Indexed'},
                              'completions': {'type': 'integer', 'minimum': 1, 'maximum': 100000},
                              'parallelism': {'type': 'integer', 'minimum': 1, 'maximum': 10000},
                              'backoffLimitPerIndex': {'type': 'integer', 'minimum': 0},
                              'podFailurePolicy': fields({'rules': {'type': 'array', 'maxItems': 20, 'items': RULE}}),
                              'template': fields({'spec': POD})})})


def is_good(job):
    """What a schema cannot say: names that refer to others."""
    if not jsonschema.Draft7Validator(JOB).is_valid(job):
        return False
    pod = job['spec']['template']['spec']
    volumes = [volume['name'] for volume in pod['volumes']]
    mounts = [mount for container in pod['containers'] for mount in container['volumeMounts']]
    names = [container['name'] for container in pod['containers']]
    rules = job['spec']['podFailurePolicy']['rules']
    return (len(set(volumes)) == len(volumes) and sorted(volumes) == sorted(mount['name'] for mount in mounts) and
            all(rule['onExitCodes']['containerName'] in names for rule in rules))


with open(path, encoding='utf-8') as file:
    job = yaml.safe_load(file)
jsonschema.validate(job, JOB)
assert is_good(job)
pod = job['spec']['template']['spec']
assert job['spec']['completions'] == int(completions)
assert pod['containers'][0]['command'] == ['krs', 'farm', 'run', folder]
assert pod['containers'][0]['image'] == 'registry.example/krs:1'
assert [volume['hostPath']['path'] for volume in pod['volumes']] == [folder, pictures]
assert [mount['mountPath'] for mount in pod['containers'][0]['volumeMounts']] == [folder, pictures]

FAULTS = [
    lambda job: job['metadata'].update(name='Krs_Job'),
    lambda job: job['spec'].update(completions='20'),
    lambda job: job['spec'].update(completionmode='Indexed'),
    lambda job: job['spec'].pop('podFailurePolicy'),
    lambda job: job['spec']['template']['spec'].update(restartPolicy='OnFailure'),
    lambda job: job['spec']['podFailurePolicy']['rules'][0]['onExitCodes'].update(values=[0]),
    lambda job: job['spec']['podFailurePolicy']['rules'][1]['onExitCodes'].update(containerName='other'),
    lambda job: job['spec']['template']['spec']['volumes'].pop(),
    lambda job: job['spec']['template']['spec']['containers'][0].pop('image'),
]
for number, plant in enumerate(FAULTS):
    spoilt = copy.deepcopy(job)
    plant(spoilt)
    assert not is_good(spoilt), f'fault {number} is not found'
