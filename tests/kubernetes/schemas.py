"""The fields of Kubernetes's and the Dask operator's resources that the manifests use, as JSON Schemas.

A field that is not here is refused, as by `kubectl apply --validate=strict`.

Source: Kubernetes API Reference 1.33 (Pod, Service, Job, PersistentVolumeClaim); Dask Kubernetes Operator, the custom
resource definition of DaskCluster, https://kubernetes.dask.org/en/latest/operator_resources.html
"""

TEXT = {"type": "string"}
NUMBER = {"type": "integer", "minimum": 0}
TRUTH = {"type": "boolean"}
NAME = {"type": "string", "pattern": "^[a-z0-9]([-a-z0-9]*[a-z0-9])?$", "maxLength": 63}
QUANTITY = {"type": "string", "pattern": r"^[0-9.]+(m|k|Ki|M|Mi|G|Gi|T|Ti)?$"}
PORT_NAME = {"type": "string", "pattern": "^[a-z0-9-]*[a-z][a-z0-9-]*$", "maxLength": 15}
WORDS = {"type": "object", "additionalProperties": TEXT}


def fields(*required, **properties):
    return {"type": "object", "additionalProperties": False, "required": list(required), "properties": properties}


def listed(items):
    return {"type": "array", "items": items, "minItems": 1}


METADATA = fields(name=NAME, labels=WORDS, annotations=WORDS)
RESOURCES = fields(**{
    name: {"type": "object", "additionalProperties": QUANTITY, "propertyNames": {"enum": ["cpu", "memory", "storage"]}}
    for name in ("requests", "limits")
})  # fmt: skip
PROBE = fields(httpGet=fields("port", path=TEXT, port={"type": ["string", "integer"]}), periodSeconds=NUMBER)
SECURITY = fields(
    runAsUser=NUMBER,
    allowPrivilegeEscalation=TRUTH,
    capabilities=fields(add=listed({"enum": ["SYS_ADMIN", "NET_ADMIN"]}), drop=listed(TEXT)),
    seccompProfile=fields("type", type={"enum": ["Unconfined", "RuntimeDefault"]}),
)
CONTAINER = fields(
    "name", "image",
    name=NAME,
    image=TEXT,
    imagePullPolicy={"enum": ["Always", "IfNotPresent", "Never"]},
    args=listed(TEXT),
    env=listed(fields("name", name=TEXT, value=TEXT)),
    ports=listed(fields("containerPort", name=PORT_NAME, containerPort=NUMBER, protocol={"enum": ["TCP", "UDP"]})),
    readinessProbe=PROBE,
    resources=RESOURCES,
    securityContext=SECURITY,
    volumeMounts=listed(fields("name", "mountPath", name=NAME, mountPath=TEXT, readOnly=TRUTH)),
)  # fmt: skip
VOLUME = fields(
    "name",
    name=NAME,
    emptyDir=fields(sizeLimit=QUANTITY),
    persistentVolumeClaim=fields("claimName", claimName=NAME),
)
POD = fields(
    "containers",
    containers=listed(CONTAINER),
    volumes=listed(VOLUME),
    restartPolicy={"enum": ["Always", "OnFailure", "Never"]},
    automountServiceAccountToken=TRUTH,
)
SERVICE_PORT = fields("port", name=PORT_NAME, port=NUMBER, targetPort={"type": ["string", "integer"]}, protocol=TEXT)
SERVICE = fields(type={"enum": ["ClusterIP", "NodePort", "LoadBalancer"]}, selector=WORDS, ports=listed(SERVICE_PORT))


def resource(version, kind, spec):
    return fields(
        "apiVersion", "kind", "metadata", "spec",
        apiVersion={"const": version}, kind={"const": kind}, metadata=METADATA | {"required": ["name"]}, spec=spec,
    )  # fmt: skip


RESTARTS = POD | {"required": ["containers", "restartPolicy"]}
SCHEMAS = {
    "DaskCluster": resource(
        "kubernetes.dask.org/v1",
        "DaskCluster",
        fields(
            "scheduler", "worker",
            idleTimeout=NUMBER,
            scheduler=fields("spec", "service", metadata=METADATA, spec=POD, service=SERVICE),
            worker=fields("spec", replicas=NUMBER, metadata=METADATA, spec=POD),
        ),
    ),
    "Job": resource("batch/v1", "Job", fields("template", backoffLimit=NUMBER, template=fields("spec", spec=RESTARTS))),
    "Pod": resource("v1", "Pod", POD),
    "PersistentVolumeClaim": resource(
        "v1",
        "PersistentVolumeClaim",
        fields(accessModes=listed({"enum": ["ReadWriteOnce", "ReadWriteMany"]}), resources=RESOURCES),
    ),
}  # fmt: skip
